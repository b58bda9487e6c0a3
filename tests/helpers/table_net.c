/* SPDX-License-Identifier: MIT
 * table_net.c - for tests: a net that is read from a table of elements (the file that PN_TABLE names) instead of being generated, so that
 * thousands of random place/transition nets can be explored by one program. One packed place, whose colours are the places of the net;
 * one transition, whose bindings are the elements. The initial marking stands behind the table.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "pn/pn_net.h"
#include "pn/pn_num.h"

enum { PLACES = 32, WIDTH = 4, MOST = 15, ELEMENTS = 512, WORDS = 2 };

typedef struct { uint32_t pre[PLACES], post[PLACES]; bool inhibits[PLACES], resets[PLACES]; } row_t;
typedef struct { uint64_t packed[WORDS]; } marking_t;

static row_t s_row[ELEMENTS];
static uint32_t s_rows, s_counters, s_initial[PLACES];

static uint32_t get(const marking_t *m, uint32_t i) { return (uint32_t)(m->packed[i / 16U] >> ((i % 16U) * 4U)) & 15U; }

static void set(marking_t *m, uint32_t i, uint32_t n)
{
    m->packed[i / 16U] &= ~((uint64_t)15U << ((i % 16U) * 4U));
    m->packed[i / 16U] |= (uint64_t)n << ((i % 16U) * 4U);
}

static uint32_t number(FILE *f) { unsigned n = 0U; if (fscanf(f, "%u", &n) != 1) { abort(); } return n; }

static void read_row(FILE *f, row_t *row)
{
    (void)number(f); /* transition */
    (void)number(f); /* useful */
    for (uint32_t n = number(f); n > 0U; n--) { const uint32_t c = number(f); row->pre[c] = number(f); }
    for (uint32_t n = number(f); n > 0U; n--) { const uint32_t c = number(f); row->post[c] = number(f); }
    for (uint32_t n = number(f); n > 0U; n--) { row->inhibits[number(f)] = true; }
    for (uint32_t n = number(f); n > 0U; n--) { row->resets[number(f)] = true; }
}

static bool init(pn_ctx_t *cx, void *marking)
{
    char line[256];
    FILE *f = fopen(getenv("PN_TABLE"), "r");
    (void)cx;
    if (f == NULL || fgets(line, sizeof line, f) == NULL) { abort(); }
    (void)number(f);
    (void)number(f); /* one place, its colours */
    s_counters = number(f);
    for (uint32_t c = 0U; c < s_counters; c++) { (void)number(f); (void)number(f); }
    s_rows = number(f);
    for (uint32_t e = 0U; e < s_rows; e++) { read_row(f, &s_row[e]); }
    while (fgets(line, sizeof line, f) != NULL && strcmp(line, "end\n") != 0) { }
    memset(marking, 0, sizeof(marking_t));
    for (uint32_t c = 0U; c < s_counters; c++) { set(marking, c, number(f)); }
    (void)fclose(f);
    return true;
}

static bool enabled(const marking_t *m, const row_t *row)
{
    for (uint32_t c = 0U; c < PLACES; c++) {
        if (get(m, c) < row->pre[c] || (row->inhibits[c] && get(m, c) > 0U)) { return false; }
    }
    return true;
}

static bool enumerate(pn_ctx_t *cx, const void *marking, uint32_t self, pn_binding_sink_t sink, void *user)
{
    (void)cx;
    for (uint32_t e = 0U; e < s_rows; e++) {
        if (enabled(marking, &s_row[e]) && !sink(user, self, &e)) { return false; }
    }
    return true;
}

static bool fire(pn_ctx_t *cx, void *marking, void *binding)
{
    const row_t *row = &s_row[*(const uint32_t *)binding];
    for (uint32_t c = 0U; c < PLACES; c++) {
        const uint32_t n = row->resets[c] ? 0U : get(marking, c) - row->pre[c] + row->post[c];
        if (n > MOST) { cx->origin = "P"; pn_raise(cx, PN_ERR_CAPACITY, "full"); return false; }
        set(marking, c, n);
    }
    return true;
}

static void binding_json(const void *binding, pn_text_t *out) { out->length += (size_t)snprintf(out->buffer + out->length, 32U, "{\"e\": %u}", *(const uint32_t *)binding); }
static void json(const void *marking, pn_text_t *out)
{
    out->length += (size_t)snprintf(out->buffer + out->length, 32U, "[");
    for (uint32_t c = 0U; c < s_counters; c++) { out->length += (size_t)snprintf(out->buffer + out->length, 32U, "%s%u", c > 0U ? ", " : "", get(marking, c)); }
    out->length += (size_t)snprintf(out->buffer + out->length, 32U, "]");
}
static bool colour_json(uint32_t i, pn_text_t *out) { out->length += (size_t)snprintf(out->buffer + out->length, 32U, "%u", i); return true; }
static uint64_t count(const void *marking) { uint64_t n = 0U; for (uint32_t c = 0U; c < PLACES; c++) { n += get(marking, c); } return n; }
static size_t encode(const void *marking, uint8_t *out, size_t capacity) { if (capacity >= sizeof(marking_t)) { memcpy(out, marking, sizeof(marking_t)); } return sizeof(marking_t); }
static size_t decode(pn_ctx_t *cx, void *marking, const uint8_t *in, size_t length) { (void)cx; (void)length; memcpy(marking, in, sizeof(marking_t)); return sizeof(marking_t); }
static pn_time_t now(const void *marking) { (void)marking; return (pn_time_t){ .integer = 0 }; }
static void collect(pn_ctx_t *cx, void *marking) { (void)cx; (void)marking; }

static const uint32_t s_touched[] = { 0U };
static const pn_place_t s_place[] = { { .name = "P", .colset = "P", .origin = "P", .owner = -1, .capacity = PLACES, .count = count, .json = json,
    .is_packed = true, .colours = PLACES, .width = WIDTH, .bit = 0U, .encode = encode, .decode = decode, .colour_json = colour_json } };
static const pn_transition_t s_transition[] = { { .name = "T", .id = "T", .origin = "T", .enumerate = enumerate, .fire = fire, .binding_json = binding_json,
    .binding_size = sizeof(uint32_t), .touched_count = 1U, .touched = s_touched } };
static const uint32_t s_order[] = { 0U };
const pn_net_t pn_net = { .abi = PN_NET_ABI, .name = "table", .source = "table", .digest = "0", .marking_size = sizeof(marking_t),
    .binding_size = sizeof(uint32_t), .place_count = 1U, .place = s_place, .transition_count = 1U, .transition = s_transition,
    .order_count = 1U, .order = s_order, .init = init, .now = now, .collect = collect, .packed_size = sizeof(marking_t) };
