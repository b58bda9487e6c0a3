/* SPDX-License-Identifier: MIT
 * odd_cell.c - the cell of odd_net.c, as cell_config.c would be generated, and tables as none would be:
 *
 *   -DODD_FINALS=N      so many final places, 0 to 2
 *   -DODD_FILE=TEXT     the name of the command's file
 *   -DODD_BETWEEN=TEXT  a channel between the robots, by the name of its file
 *   -DODD_ARENA=N       bytes for lists and strings
 *   -DODD_NO_COLLECT    nothing refers into them
 *   -DODD_NO_CHANNELS   a party that has none
 *   -DODD_NO_OWNER      no party: all transitions are the program's
 */
#include "pn/pn_arena.h"
#include "pn/pn_cell.h"
#include "pn/pn_file.h"
#include "pn/pn_marking.h"

#include <stddef.h>

#ifndef ODD_FINALS
#define ODD_FINALS 2U
#endif
#ifndef ODD_FILE
#define ODD_FILE "command.robcad"
#endif
#ifndef ODD_ARENA
#define ODD_ARENA 65536U
#endif

void odd_collect(const pn_net_t *net, pn_ctx_t *cx, void *marking);
bool odd_next_time(const pn_net_t *net, pn_ctx_t *cx, const void *marking, pn_time_t *next);

static max_align_t s_marking[256];
static max_align_t s_binding[4];
static const size_t BINDING_SIZE = sizeof s_binding;
static uint64_t s_fired_of[8];
static max_align_t s_arena[ODD_ARENA / sizeof(max_align_t)];

#define LABEL_60 "of-sixty-letters-and-therefore-too-long-for-a-list-of-columns"

static const pn_scalar_t TEXT[] = { { .kind = PN_SCALAR_STRING, .label = "text", .colset = "TEXT" } };
static const pn_scalar_t TOLD[] = { { .kind = PN_SCALAR_STRING, .label = "text", .colset = "TOLD" } };
static const pn_scalar_t NAME[] = {
    { .kind = PN_SCALAR_STRING, .label = LABEL_60 LABEL_60 LABEL_60 LABEL_60 LABEL_60, .colset = "TOLD" }
};
static const pn_scalar_t WHOLE[] = { { .kind = PN_SCALAR_INT, .label = "INTINF", .colset = "INTINF" } };
static const pn_scalar_t LEVEL[] = { { .kind = PN_SCALAR_REAL, .label = "REAL", .colset = "REAL" } };
static const pn_scalar_t FLAG[] = {
    { .kind = PN_SCALAR_INT, .label = "flag", .colset = "FLAG", .bounded = true, .low = 1, .high = 100 }
};
static const pn_scalar_t ORDER[] = { { .kind = PN_SCALAR_INT, .label = "n", .colset = "ORDER" } };

static const pn_cell_channel_t CHANNEL[] = {
    { "say", "say.robcad", 5U, "Odd.say", PN_CHANNEL_OUT, PN_CHANNEL_DATA, 0U, 1U, TEXT },
    { "big", "big.robcad", 6U, "Odd.big", PN_CHANNEL_OUT, PN_CHANNEL_DATA, 0U, 1U, WHOLE },
    { "level", "level.robcad", 7U, "Odd.level", PN_CHANNEL_OUT, PN_CHANNEL_DATA, 0U, 1U, LEVEL },
    { "told", "told.robcad", 9U, "Odd.told", PN_CHANNEL_IN, PN_CHANNEL_DATA, 0U, 1U, TOLD },
    { "command", ODD_FILE, 8U, "Odd.command", PN_CHANNEL_OUT, PN_CHANNEL_FLAG, 0U, 1U, FLAG },
    { "answer", "answer.robcad", 10U, "Odd.answer", PN_CHANNEL_IN, PN_CHANNEL_FLAG, 0U, 1U, FLAG },
};
static const pn_cell_input_t INPUT[] = {
    { "orders", "orders.txt", 0U, "Odd.Orders", 1U, ORDER, false, 0U },
    { "name", "name.txt", 1U, "Odd.Name", 1U, NAME, true, 0x18ae13aaU }, /* checked with "nobody" */
};
static const pn_cell_peer_t PEER[] = { { "robot1", 1 }, { "robot2", 2 } };
static const uint32_t FINAL[] = { 3U, 4U };
#ifdef ODD_BETWEEN
static const char *const BETWEEN[] = { ODD_BETWEEN };
#endif

const pn_cell_t pn_cell = {
    .abi = PN_CELL_ABI,
    .name = "odd",
    .version = "0",
    .digest = "0000",
    .side = "supervisor",
#ifdef ODD_NO_OWNER
    .owner = -1,
#else
    .owner = 0,
#endif
    .reply_timeout_s = 5.0,
#ifndef ODD_NO_CHANNELS
    .channel_count = sizeof CHANNEL / sizeof CHANNEL[0],
#endif
    .channel = CHANNEL,
#ifdef ODD_BETWEEN
    .between_count = 1U,
    .between = BETWEEN,
#endif
    .input_count = 2U,
    .input = INPUT,
    .peer_count = 2U,
    .peer = PEER,
    .final_count = ODD_FINALS,
    .final_place = FINAL,
    .arena = s_arena,
    .arena_size = sizeof s_arena,
    .room = { .marking = s_marking,
              .marking_size = sizeof s_marking,
              .binding = s_binding,
              .binding_size = &BINDING_SIZE,
              .fired_of = s_fired_of,
              .transition_count = 8U },
    .needs = {
#ifdef ODD_NO_CHANNELS
        .run = sup_run_alone,
#else
        .run = sup_run_cell,
#endif
        .allow_files = pn_file_allow,
#ifndef ODD_NO_COLLECT
        .collect = odd_collect,
#endif
        .next_time = odd_next_time,
    },
};
