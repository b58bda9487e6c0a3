/* SPDX-License-Identifier: MIT
 * explore_counting.c - transitions that only count, see explore_counting.h.
 */
#include <string.h>

#include "pn/explore_counting.h"
#include "pn/pn_marking.h"
#include "pn/pn_packed.h"

const pn_type_t pn_counting_type = { .kind = PN_KIND_RECORD,
                                     .name = "()",
                                     .size = sizeof(pn_counting_binding_t),
                                     .count = 0U,
                                     .field = NULL };

static const pn_counting_t *counting_of(uint32_t self)
{
    return pn_net.transition[self].places;
}

static bool is_enabled(const pn_counting_t *t, const uint64_t *word)
{
    for (uint32_t i = 0U; i < t->count; i++) {
        const pn_count_t *const c = &t->row[i];
        if (pn_counter(word, c->bit, c->width, 0U) < c->needs) {
            return false;
        }
    }
    return true;
}

/* Raises an error where tokens are missing, or where there is no room for them. */
static bool is_possible(pn_ctx_t *cx, const pn_count_t *c, const uint64_t *word)
{
    const uint32_t held = pn_counter(word, c->bit, c->width, 0U);
    if (held < c->takes) {
        return pn_fail_missing(cx);
    }
    return (c->puts <= (pn_counter_most(c->width) - (held - c->takes))) || pn_multiset_fail_full(cx, c->multiset);
}

static void change(const pn_count_t *c, uint64_t *word)
{
    pn_counter_subtract(word, c->bit, c->width, 0U, c->takes);
    pn_counter_add(word, c->bit, c->width, 0U, c->puts);
}

static bool occur(pn_ctx_t *cx, const pn_counting_t *t, uint64_t *word)
{
    for (uint32_t i = 0U; i < t->count; i++) {
        if (!is_possible(cx, &t->row[i], word)) {
            return false;
        }
        change(&t->row[i], word);
    }
    return true;
}

static void begin(pn_ctx_t *cx, const void *marking, uint32_t self)
{
    pn_begin(cx, pn_net.transition[self].origin, pn_now(&pn_net, marking));
}

bool pn_counting_enumerate(pn_ctx_t *cx, const void *marking, uint32_t self, pn_binding_sink_t sink, void *user)
{
    const pn_counting_binding_t binding = { 0 };
    begin(cx, marking, self);
    return !is_enabled(counting_of(self), marking) || sink(user, self, &binding);
}

bool pn_counting_fire(pn_ctx_t *cx, void *marking, uint32_t self, void *binding)
{
    (void)binding;
    begin(cx, marking, self);
    return occur(cx, counting_of(self), marking);
}

bool pn_counting_successors(pn_ctx_t *cx, const void *marking, uint32_t self, void *next, pn_successor_sink_t sink,
                            void *user)
{
    const pn_counting_t *const t = counting_of(self);
    const pn_counting_binding_t binding = { 0 };
    begin(cx, marking, self);
    if (!is_enabled(t, marking)) {
        return true;
    }
    (void)memcpy(next, marking, pn_net.marking_size);
    return occur(cx, t, next) && sink(user, self, &binding, next);
}

bool pn_counting_words(pn_words_t *words, uint32_t self)
{
    const pn_counting_t *const t = counting_of(self);
    const uint64_t *const word = words->marking;
    begin(words->cx, word, self);
    if (!is_enabled(t, word)) {
        return true;
    }
    uint64_t first = word[0];
    for (uint32_t i = 0U; i < t->count; i++) {
        if (!is_possible(words->cx, &t->row[i], word)) {
            return false;
        }
        if (t->row[i].bit < 64U) {
            change(&t->row[i], &first);
        }
    }
    return pn_words_add(words, first & t->key);
}
