/* SPDX-License-Identifier: MIT
 * codec_cell.c - channels of all kinds of scalars for the host messages.c, and tables that no cell has: a kind that
 * there is not, and more scalars than a message may have. tests/situations/codec.py has the same as Python.
 */
#include "pn/pn_cell.h"

#include <stddef.h>

static const char *const COLOURS[] = { "red", "green" };
static const char *const UNIT[] = { "u" };

static const pn_scalar_t SCALARS[] = {
    { .kind = PN_SCALAR_UNIT, .label = "UNIT", .colset = "UNIT" },
    { .kind = PN_SCALAR_UNIT, .label = "named", .colset = "U", .name_count = 1U, .name = UNIT },
    { .kind = PN_SCALAR_BOOL, .label = "BOOL", .colset = "BOOL" },
    { .kind = PN_SCALAR_ENUM, .label = "c", .colset = "COLOUR", .name_count = 2U, .name = COLOURS },
    { .kind = PN_SCALAR_INDEX, .label = "i", .colset = "INDEX", .bounded = true, .low = 1, .high = 3 },
    { .kind = PN_SCALAR_INT, .label = "n", .colset = "RANGE", .bounded = true, .low = -2, .high = 8 },
    { .kind = PN_SCALAR_INT, .label = "INT", .colset = "INT" },
    { .kind = PN_SCALAR_REAL, .label = "x", .colset = "SPAN", .bounded = true, .real_low = -1.5, .real_high = 2.5 },
    { .kind = PN_SCALAR_REAL, .label = "REAL", .colset = "REAL" },
    { .kind = PN_SCALAR_STRING, .label = "s", .colset = "STRING" },
    { .kind = PN_SCALAR_STRING, .label = "t", .colset = "STRING" },
};
static const pn_scalar_t NUMBERED[] = {
    { .kind = PN_SCALAR_STRING, .label = "s", .colset = "STRING" },
    { .kind = PN_SCALAR_INT, .label = "n", .colset = "INT" },
};
static const pn_scalar_t MEASURED[] = {
    { .kind = PN_SCALAR_STRING, .label = "s", .colset = "STRING" },
    { .kind = PN_SCALAR_REAL, .label = "x", .colset = "REAL" },
};
static const pn_scalar_t LISTED[] = {
    { .kind = PN_SCALAR_INT, .label = "n", .colset = "INT" },
    { .kind = PN_SCALAR_LIST, .label = "l", .colset = "PAIRS", .bounded = true, .high = 40, .element_count = 2U },
    { .kind = PN_SCALAR_INT, .label = "m", .colset = "INT" },
    { .kind = PN_SCALAR_STRING, .label = "s", .colset = "STRING" },
    { .kind = PN_SCALAR_LIST,
      .label = "o",
      .colset = "NUMBERS",
      .bounded = true,
      .low = 1,
      .high = INT64_MAX,
      .element_count = 1U },
    { .kind = PN_SCALAR_INT, .label = "k", .colset = "RANGE", .bounded = true, .low = -2, .high = 8 },
    { .kind = PN_SCALAR_BOOL, .label = "b", .colset = "BOOL" },
};
static const pn_scalar_t UNKNOWN[] = { { .kind = (pn_scalar_kind_t)99, .label = "odd", .colset = "ODD" } };

#define OUT(name, count, scalars) \
    { name, name ".robcad", 0U, "", PN_CHANNEL_OUT, PN_CHANNEL_DATA, 0U, (count), (scalars) }

static const pn_cell_channel_t CHANNEL[] = {
    OUT("all", 11U, SCALARS),  OUT("text", 2U, &SCALARS[9]),  OUT("unknown", 1U, UNKNOWN),
    OUT("many", 65U, SCALARS), OUT("numbered", 2U, NUMBERED), OUT("measured", 2U, MEASURED),
    OUT("listed", 7U, LISTED),
};

const pn_cell_t pn_cell = { .channel_count = 7U, .channel = CHANNEL };
