/* SPDX-License-Identifier: MIT
 * supervisor_input.c - markings that come from files (cell.toml, `[[input]]`).
 *
 * A file holds one token: one line for each top-level component of its colour set, or a single line where all of these
 * are scalars, values separated by blanks. Empty lines and lines that begin with `#` are passed over. Mistakes are
 * reported as file:line:column.
 */
#include "supervisor_impl.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "pn/pn_port.h"

#define INPUT_MAX 65536U /* bytes of an input file */

typedef struct input_text {
    char path[1024];
    char bytes[INPUT_MAX];
    size_t length;
    size_t at;                            /* of the next line */
    uint32_t line;                        /* number of the last line taken */
    char columns[256];                    /* "x y z rx ry rz": what a line should hold */
    uint32_t line_of[PN_CHANNEL_SCALARS]; /* of each value */
} input_text_t;

static bool read_file(sup_t *sup, const pn_cell_input_t *input, input_text_t *text)
{
    const int length = snprintf(text->path, sizeof text->path, "%s/%s", sup->options.input, input->file);
    if ((size_t)length >= sizeof text->path) { /* a negative length is a large one here */
        return sup_stop(sup, SUP_EXIT_USAGE, "the path of the input file %s is too long", input->file);
    }
    if (strcmp(sup->options.input, ".") == 0) {
        (void)snprintf(text->path, sizeof text->path, "%s", input->file);
    }
    const int error = pn_port_load(text->path, text->bytes, sizeof text->bytes, &text->length);
    text->at = 0U;
    text->line = 0U;
    if (error != 0) {
        return sup_stop(sup, SUP_EXIT_USAGE,
                        "%s: cannot read the input file of place `%s`: %s; give its directory with --input DIR",
                        text->path, input->place_name, strerror(error));
    }
    if (text->length == sizeof text->bytes) {
        return sup_stop(sup, SUP_EXIT_USAGE, "%s: longer than the %u bytes that an input file may have", text->path,
                        INPUT_MAX);
    }
    return true;
}

/* The next line that is neither blank nor a comment. */
static bool take_line(input_text_t *text, const char **line, size_t *length)
{
    bool found = false;
    while (!found && (text->at < text->length)) {
        const char *const begin = text->bytes + text->at;
        const char *const end = memchr(begin, '\n', text->length - text->at);
        const ptrdiff_t distance = (end != NULL) ? (end - begin) : 0;
        const size_t n = (end != NULL) ? (size_t)distance : text->length - text->at;
        text->at += n + ((end != NULL) ? 1U : 0U);
        text->line++;
        size_t first = 0U;
        while ((first < n) && ((begin[first] == ' ') || (begin[first] == '\t') || (begin[first] == '\r'))) {
            first++;
        }
        found = (first < n) && (begin[first] != '#');
        *line = begin;
        *length = n;
    }
    return found;
}

/* "x y z": the labels of the scalars of one line. */
static const char *labels(const pn_scalar_t *scalar, uint32_t count, char *out, size_t capacity)
{
    size_t at = 0U;
    out[0] = '\0';
    for (uint32_t i = 0U; i < count; i++) {
        const int put = snprintf(out + at, capacity - at, "%s`%s`", (i > 0U) ? " " : "", scalar[i].label);
        if ((size_t)put >= capacity - at) {
            return out;
        }
        at += (size_t)put;
    }
    return out;
}

static bool parse(sup_t *sup, const pn_cell_input_t *input, input_text_t *text, pn_message_t *token)
{
    const pn_type_t *const type = sup->net->place[input->place].multiset->type;
    const uint32_t lines = pn_line_count(type);
    const char *line = NULL;
    size_t length = 0U;
    uint32_t done = 0U;
    token->count = 0U;
    token->text_length = 0U;
    for (uint32_t i = 0U; i < lines; i++) {
        const uint32_t wanted = pn_line_scalars(type, i);
        const pn_scalar_t *const scalar = &input->scalar[done];
        (void)labels(scalar, wanted, text->columns, sizeof text->columns);
        if (!take_line(text, &line, &length)) {
            return sup_stop(sup, SUP_EXIT_USAGE,
                            "%s:%" PRIu32 ":1: the file ends where line %" PRIu32 " of %" PRIu32
                            " is expected: %" PRIu32 " value%s (%s)",
                            text->path, text->line + 1U, i + 1U, lines, wanted, (wanted == 1U) ? "" : "s",
                            text->columns);
        }
        if (!pn_scalars_parse(scalar, wanted, line, length, token)) {
            return sup_stop(sup, SUP_EXIT_USAGE,
                            "%s:%" PRIu32 ":%" PRIu32 ": %s (this line holds %" PRIu32 " value%s: %s)", text->path,
                            text->line, token->column, token->report, wanted, (wanted == 1U) ? "" : "s", text->columns);
        }
        for (uint32_t k = 0U; k < wanted; k++) { /* all of them fit: pn_scalars_parse has found room for them */
            text->line_of[done] = text->line;
            done++;
        }
    }
    if (take_line(text, &line, &length)) {
        char shown[160];
        return sup_stop(sup, SUP_EXIT_USAGE,
                        "%s:%" PRIu32 ":1: found %s after the %" PRIu32 " line%s that belong%s here", text->path,
                        text->line, pn_quote(line, length, shown, sizeof shown), lines, (lines == 1U) ? "" : "s",
                        (lines == 1U) ? "s" : "");
    }
    return true;
}

/* The values are right one by one, but the place does not take the token: says which of them may be the reason. */
static bool stop_for_colour(sup_t *sup, const pn_cell_input_t *input, const input_text_t *text,
                            const pn_message_t *token)
{
    const pn_place_t *const place = &sup->net->place[input->place];
    for (uint32_t i = 0U; i < token->count; i++) {
        if ((token->value[i].kind == PN_VALUE_REAL) && (fabs(token->value[i].real) > (double)FLT_MAX)) {
            return sup_stop(sup, SUP_EXIT_USAGE,
                            "%s:%" PRIu32 ":%" PRIu32
                            ": %g is too large for `%s` of colour set `%s`, which is stored in single "
                            "precision",
                            text->path, text->line_of[i], token->column_of[i], token->value[i].real,
                            input->scalar[i].label, input->scalar[i].colset);
        }
    }
    return sup_stop(sup, SUP_EXIT_USAGE,
                    "%s:%" PRIu32 ":%" PRIu32 ": the token that begins here is not in the colour set `%s` of "
                    "place `%s`",
                    text->path, text->line_of[0], token->column_of[0], place->colset, place->name);
}

/* What was proved of the cell (head of cell_config.c) holds for the token that it was checked with: says so where this
 * is another one. */
static void compare_with_checked(const sup_t *sup, const pn_cell_input_t *input, input_text_t *text)
{
    pn_scalar_value_t scalar_value[PN_CHANNEL_SCALARS];
    const pn_multiset_t *const multiset = sup->net->place[input->place].multiset;
    const uint32_t count = pn_multiset_token(multiset, sup->marking, 0U, scalar_value, PN_CHANNEL_SCALARS);
    const size_t length = pn_scalars_format(input->scalar, count, scalar_value, text->bytes, sizeof text->bytes);
    if (pn_crc32(0U, text->bytes, length) != input->checked) {
        sup_warn("%s: not the token that the cell was checked with: `pn2code verify --input` checks it with this one",
                 text->path);
    }
}

bool sup_read_inputs(sup_t *sup)
{
    static input_text_t text;
    static pn_message_t token;
    for (uint32_t i = 0U; i < sup->cell->input_count; i++) {
        const pn_cell_input_t *const input = &sup->cell->input[i];
        const pn_place_t *const place = &sup->net->place[input->place];
        if (!read_file(sup, input, &text) || !parse(sup, input, &text, &token)) {
            return false;
        }
        pn_multiset_clear(place->multiset, sup->marking);
        if (!pn_marking_put(sup->net, &sup->cx, sup->marking, input->place, token.value, token.count)) {
            if (sup->cx.error != PN_ERR_COLOUR) {
                return sup_stop_error(sup, "putting the token of an input file");
            }
            sup->cx.error = PN_OK;
            return stop_for_colour(sup, input, &text, &token);
        }
        if (input->is_checked) {
            compare_with_checked(sup, input, &text);
        }
    }
    return true;
}
