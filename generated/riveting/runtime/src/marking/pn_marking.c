/* SPDX-License-Identifier: MIT */
#include "pn/pn_marking.h"

#include "pn/pn_arena.h"
#include "pn/pn_num.h"
#include "pn/pn_random.h"

/* A marking without tokens, at time 0, in memory that may hold anything. */
static void make_empty(const pn_net_t *net, void *marking)
{
    (void)memset(marking, 0, ((net->packed_size + 7U) / 8U) * 8U); /* the packed part is whole 64-bit words */
    pn_set_now(net, marking, (pn_time_t){ .integer = 0 });
    for (uint32_t i = 0U; i < net->multiset_count; i++) {
        pn_multiset_begin(net->place[net->multisets[i]].multiset, marking);
    }
}

size_t pn_binding_size(const pn_net_t *net)
{
    size_t most = 1U;
    for (uint32_t i = 0U; i < net->transition_count; i++) {
        const size_t size = net->transition[i].binding->size;
        most = (size > most) ? size : most;
    }
    return most;
}

bool pn_marking_init(const pn_net_t *net, pn_ctx_t *cx, void *marking)
{
    make_empty(net, marking);
    pn_arena_reset(cx->arena);
    cx->now = pn_now(net, marking);
    cx->rounds = 0U;
    cx->step = 0U;
    pn_random_start(cx, PN_RANDOM_START);
    if (net->set_up != NULL) {
        net->set_up(cx);
    }
    pn_arena_seal(cx->arena);
    for (uint32_t i = 0U; pn_ok(cx) && (i < net->place_count); i++) {
        if ((net->place[i].initial != NULL) && !net->place[i].initial(cx, marking)) {
            return false;
        }
    }
    return pn_ok(cx);
}

bool pn_marking_put(const pn_net_t *net, pn_ctx_t *cx, void *marking, uint32_t place,
                    const pn_scalar_value_t *scalar_value, uint32_t scalars)
{
    cx->now = pn_now(net, marking);
    return pn_multiset_put(cx, net->place[place].multiset, marking, scalar_value, scalars);
}

bool pn_next_time(const pn_net_t *net, pn_ctx_t *cx, const void *marking, pn_time_t *next)
{
    bool found = false;
    for (uint32_t i = 0U; i < net->place_count; i++) {
        pn_multiset_next_time(net->place[i].multiset, marking, pn_now(net, marking), &found, next);
    }
    if (net->thresholds != NULL) {
        net->thresholds(cx, marking, &found, next);
    }
    return pn_ok(cx) && found;
}

size_t pn_marking_encode(const pn_net_t *net, const void *marking, uint8_t *out, size_t capacity)
{
    const pn_time_t now = pn_now(net, marking);
    size_t at = sizeof now;
    if (capacity < at) {
        return 0U;
    }
    (void)memcpy(out, &now, at);
    for (uint32_t i = 0U; i < net->place_count; i++) {
        const size_t room = (at < capacity) ? (capacity - at) : 0U;
        at += pn_multiset_encode(net->place[i].multiset, marking, &out[(room > 0U) ? at : 0U], room);
    }
    return (at <= capacity) ? at : 0U;
}

bool pn_marking_decode(const pn_net_t *net, pn_ctx_t *cx, void *marking, const uint8_t *in, size_t length)
{
    pn_time_t now;
    size_t at = sizeof now;
    if (length < at) {
        return false;
    }
    make_empty(net, marking);
    (void)memcpy(&now, in, at);
    pn_set_now(net, marking, now);
    for (uint32_t i = 0U; i < net->place_count; i++) {
        const size_t size = pn_multiset_decode(cx, net->place[i].multiset, marking, &in[at], length - at);
        if (size == SIZE_MAX) {
            return false;
        }
        at += size;
    }
    return at == length;
}

void pn_marking_collect(const pn_net_t *net, pn_ctx_t *cx, void *marking)
{
    pn_arena_flip(cx->arena);
    for (uint32_t i = 0U; i < net->refer_count; i++) {
        pn_multiset_relocate(cx, net->place[net->refer[i]].multiset, marking);
    }
    for (uint32_t i = 0U; i < net->held_count; i++) {
        pn_relocate(cx, net->held[i].type, net->held[i].variable);
    }
}
