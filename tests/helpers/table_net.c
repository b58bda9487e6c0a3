/* SPDX-License-Identifier: MIT
 * table_net.c - for tests: a net that is read from a table of elements (the file that PN_TABLE names) instead of being generated, so that
 * thousands of random place/transition nets can be explored by one program. One packed place, whose colours are the places of the net;
 * one transition, whose bindings are the elements. The initial marking stands behind the table.
 */
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "pn/pn_multiset.h"
#include "pn/pn_net.h"
#include "pn/pn_num.h"

enum { PLACES = 32, WIDTH = 4, MOST = 15, ELEMENTS = 512, WORDS = 2 };

typedef struct { uint32_t pre[PLACES], post[PLACES]; bool inhibits[PLACES], resets[PLACES]; } row_t;
typedef struct { uint64_t packed[WORDS]; pn_time_t now; } marking_t;

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
    for (int64_t e = 0; e < (int64_t)s_rows; e++) {
        if (enabled(marking, &s_row[e]) && !sink(user, self, &e)) { return false; }
    }
    return true;
}

static bool fire(pn_ctx_t *cx, void *marking, uint32_t self, void *binding)
{
    const row_t *row = &s_row[*(const int64_t *)binding];
    (void)self;
    for (uint32_t c = 0U; c < PLACES; c++) {
        const uint32_t n = row->resets[c] ? 0U : get(marking, c) - row->pre[c] + row->post[c];
        if (n > MOST) { cx->origin = "P"; pn_raise(cx, PN_ERR_CAPACITY, "full"); return false; }
        set(marking, c, n);
    }
    return true;
}

static uint32_t number_of(const void *value) { const int64_t n = *(const int64_t *)value; return (n >= 0 && n < PLACES) ? (uint32_t)n : PN_NO_COLOUR; }
static void colour_of(uint32_t i, void *value) { *(int64_t *)value = (int64_t)i; }

static const pn_type_t s_int = { .kind = PN_KIND_INT, .name = "INT", .size = sizeof(int64_t) };
static const pn_field_t s_field[] = { { "e", &s_int, 0U, false } };
static const pn_type_t s_element = { .kind = PN_KIND_RECORD, .name = "T", .size = sizeof(int64_t), .count = 1U, .field = s_field };
static const pn_multiset_t s_multiset = { .origin = "P", .type = &s_int, .capacity = PLACES, .is_packed = true, .colours = PLACES, .width = WIDTH, .number_of = number_of, .colour_of = colour_of };
static const uint32_t s_touched[] = { 0U };
static const pn_place_t s_place[] = { { .name = "P", .colset = "P", .owner = -1, .multiset = &s_multiset, .initial = init } };
static const pn_transition_t s_transition[] = { { .name = "T", .id = "T", .origin = "T", .enumerate = enumerate, .fire = fire, .binding = &s_element,
    .touched_count = 1U, .touched = s_touched } };
static const uint32_t s_order[] = { 0U };
const pn_net_t pn_net = { .abi = PN_NET_ABI, .name = "table", .source = "table", .digest = "0", .marking_size = sizeof(marking_t),
    .place_count = 1U, .place = s_place, .transition_count = 1U, .transition = s_transition,
    .order_count = 1U, .order = s_order, .now_at = offsetof(marking_t, now), .packed_size = sizeof(((marking_t *)0)->packed) };
