/* SPDX-License-Identifier: MIT
 * walk.c - a random walk through a net for comparison with the token game: after each step everything is printed.
 *
 *     walk SEED STEPS [ARENA]
 *
 * prints JSON lines {"t": now, "enabled": [[transition, binding], ...], "marking": {...}, "chosen": i}, `chosen` being
 * -1 at the end, or {"error": name}. Every marking is encoded, decoded and encoded again, and collected, on the way,
 * and its successors are made in both ways, if the net has two; what references hold is saved and restored, too. The
 * arena has ARENA bytes: those that a deployed program would have.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "pn/pn_arena.h"
#include "pn/pn_marking.h"
#include "pn/pn_net.h"
#include "pn/pn_num.h"
#include "pn/pn_random.h"
#include "pn/pn_root.h"
#include "pn/pn_text.h"

#define MOST 4096U

static max_align_t s_memory[PN_ARENA_DEFAULT_SIZE / sizeof(max_align_t)];
static max_align_t s_apart[PN_ARENA_DEFAULT_SIZE / sizeof(max_align_t)];
static char s_text[1U << 24U];
static uint8_t s_bytes[2][1U << 22U];
static uint8_t s_roots[2][1U << 22U];

typedef struct list {
    pn_text_t *text;
    uint64_t count;
    uint64_t wanted;
    void *binding;
    uint32_t transition;
} list_t;

static bool list_one(void *user, uint32_t transition, const void *binding)
{
    list_t *list = user;
    if (list->text != NULL) {
        pn_text_str(list->text, (list->count > 0U) ? ", [" : "[");
        pn_text_json_str(list->text, pn_net.transition[transition].name);
        pn_text_str(list->text, ", ");
        pn_json(pn_net.transition[transition].binding, binding, list->text);
        pn_text_char(list->text, ']');
    } else if (list->count == list->wanted) {
        (void)memcpy(list->binding, binding, pn_net.transition[transition].binding->size);
        list->transition = transition;
        return false;
    }
    list->count++;
    return true;
}

/* All enabled binding elements of the best priority. */
static void enumerate(pn_ctx_t *cx, const void *marking, list_t *list)
{
    int32_t best = 0;
    for (uint32_t k = 0U; k < pn_net.order_count; k++) {
        const uint32_t i = pn_net.order[k];
        if ((list->count > 0U) && (pn_net.transition[i].priority > best)) {
            return;
        }
        best = pn_net.transition[i].priority;
        if (!pn_net.transition[i].enumerate(cx, marking, i, list_one, list)) {
            return;
        }
    }
}

/* What references hold, as bytes; they may hold it again. */
static size_t save_roots(uint8_t *bytes)
{
    const size_t length = pn_roots_encode(pn_net.root, pn_net.root_count, bytes, sizeof s_roots[0]);
    return (length <= sizeof s_roots[0]) ? length : 0U;
}

static void restore_roots(pn_ctx_t *cx, size_t length)
{
    if ((pn_net.root_count > 0U) && !pn_roots_decode(cx, pn_net.root, pn_net.root_count, s_roots[0], length)) {
        pn_raise(cx, PN_ERR_INTERNAL, "references cannot be restored");
    }
}

/* The same in memory of their own, where everything has the same address each time. */
static void restore_apart(pn_ctx_t *cx, size_t length)
{
    pn_arena_t apart;
    pn_arena_t *const arena = cx->arena;
    pn_arena_init(&apart, s_apart, sizeof s_apart);
    cx->arena = &apart;
    restore_roots(cx, length);
    cx->arena = arena;
}

static void check_codec(pn_ctx_t *cx, void *marking, void *copy)
{
    const size_t held = save_roots(s_roots[0]);
    restore_roots(cx, held);
    const size_t length = pn_marking_encode(&pn_net, marking, s_bytes[0], sizeof s_bytes[0]);
    if ((length == 0U) || !pn_marking_decode(&pn_net, cx, copy, s_bytes[0], length)
        || (pn_marking_encode(&pn_net, copy, s_bytes[1], sizeof s_bytes[1]) != length)
        || (memcmp(s_bytes[0], s_bytes[1], length) != 0)) {
        pn_raise(cx, PN_ERR_INTERNAL, "encode and decode disagree");
    }
    pn_marking_collect(&pn_net, cx, marking);
    if ((pn_marking_encode(&pn_net, marking, s_bytes[1], sizeof s_bytes[1]) != length)
        || (memcmp(s_bytes[0], s_bytes[1], length) != 0)) {
        pn_raise(cx, PN_ERR_INTERNAL, "collect changed the marking");
    }
    if ((save_roots(s_roots[1]) != held) || (memcmp(s_roots[0], s_roots[1], held) != 0)) {
        pn_raise(cx, PN_ERR_INTERNAL, "references hold something else when they are restored and collected");
    }
}

/* --- successors: the same as those of enumerate and fire ---------------------------------------------------------- */

typedef struct pass {
    pn_ctx_t *cx;
    const void *marking;
    void *next;
    void *binding;
    size_t held; /* by references */
    uint64_t count;
    uint64_t hash;
} pass_t;

static bool note_successor(void *user, uint32_t transition, const void *binding, const void *next)
{
    pass_t *pass = user;
    static char text[1U << 16U];
    pn_text_t json;
    pn_text_init(&json, text, sizeof text);
    pn_json(pn_net.transition[transition].binding, binding, &json);
    const size_t length = pn_marking_encode(&pn_net, next, s_bytes[1], sizeof s_bytes[1]);
    for (size_t i = 0U; i < (length + json.length); i++) {
        pass->hash = (pass->hash ^ ((i < length) ? s_bytes[1][i] : (uint8_t)text[i - length])) * 0x100000001B3U;
    }
    pass->hash = (pass->hash ^ transition) * 0x100000001B3U;
    pass->count++;
    restore_apart(pass->cx, pass->held);
    return true;
}

static bool note_fired(void *user, uint32_t transition, const void *binding)
{
    pass_t *pass = user;
    const uint64_t random = pass->cx->random; /* the search goes on with its own numbers */
    (void)memcpy(pass->binding, binding, pn_net.transition[transition].binding->size);
    (void)memcpy(pass->next, pass->marking, pn_net.marking_size);
    const bool goes_on = pn_net.transition[transition].fire(pass->cx, pass->next, transition, pass->binding)
                         && note_successor(user, transition, pass->binding, pass->next);
    pass->cx->random = random;
    return goes_on;
}

static void check_successors(pn_ctx_t *cx, const void *marking, void *next, void *binding)
{
    const size_t held = save_roots(s_roots[0]);
    for (uint32_t t = 0U; t < pn_net.transition_count; t++) {
        const pn_transition_t *transition = &pn_net.transition[t];
        if ((transition->successors == NULL) || transition->looks_outside) {
            continue;
        }
        pass_t pass[2] = { { cx, marking, next, binding, held, 0U, 0U }, { cx, marking, next, binding, held, 0U, 0U } };
        pn_error_t error[2];
        for (uint32_t k = 0U; k < 2U; k++) {
            const pn_ctx_t before = *cx;
            const pn_arena_t arena = *cx->arena;
            restore_apart(cx, held);
            bool goes_on = false;
            if (k == 0U) {
                goes_on = transition->successors(cx, marking, t, next, note_successor, &pass[k]);
            } else {
                goes_on = transition->enumerate(cx, marking, t, note_fired, &pass[k]);
            }
            error[k] = (goes_on || (cx->error != PN_OK)) ? cx->error : PN_ERR_INTERNAL;
            *cx = before;
            *cx->arena = arena;
        }
        if ((error[0] != error[1]) || (pass[0].count != pass[1].count) || (pass[0].hash != pass[1].hash)) {
            pn_raise(cx, PN_ERR_INTERNAL, "successors are others than enumerate and fire make");
        }
    }
    restore_roots(cx, held);
}

static void print_step(const void *marking, pn_text_t *text, int64_t chosen)
{
    pn_text_str(text, "], \"t\": ");
    if (pn_net.real_time) {
        pn_text_json_real(text, pn_now(&pn_net, marking).real);
    } else {
        pn_text_int(text, pn_now(&pn_net, marking).integer);
    }
    pn_text_str(text, ", \"marking\": {");
    for (uint32_t i = 0U; i < pn_net.place_count; i++) {
        pn_text_str(text, (i > 0U) ? ", " : "");
        pn_text_json_str(text, pn_net.place[i].name);
        pn_text_str(text, ": ");
        pn_multiset_json(pn_net.place[i].multiset, marking, text);
    }
    pn_text_str(text, "}, \"chosen\": ");
    pn_text_int(text, chosen);
    pn_text_char(text, '}');
    (void)puts(text->truncated ? "{\"error\": \"output too long\"}" : text->buffer);
}

static bool step(pn_ctx_t *cx, void *marking, void *copy, void *binding)
{
    const pn_time_t start = pn_now(&pn_net, marking);
    pn_time_t next = start;
    pn_text_t text;
    list_t all = { &text, 0U, 0U, NULL, 0U };
    for (bool more = true; more;) {
        pn_text_init(&text, s_text, sizeof s_text);
        pn_text_str(&text, "{\"enabled\": [");
        enumerate(cx, marking, &all);
        more = (all.count == 0U) && pn_ok(cx) && pn_net.timed && pn_next_time(&pn_net, cx, marking, &next);
        if (more) {
            pn_set_now(&pn_net, marking, next);
        }
    }
    if (all.count == 0U) {
        pn_set_now(&pn_net, marking, start);
    }
    if (!pn_ok(cx)) {
        return false;
    }
    pn_random_start(cx, PN_RANDOM_CHOICE);
    const int64_t chosen = (all.count == 0U) ? -1 : pn_random_below(cx, (int64_t)all.count);
    print_step(marking, &text, chosen);
    if (chosen < 0) {
        return false;
    }
    check_codec(cx, marking, copy);
    check_successors(cx, marking, copy, binding);
    list_t one = { NULL, 0U, (uint64_t)chosen, binding, 0U };
    enumerate(cx, marking, &one);
    cx->step++;
    return pn_ok(cx) && pn_net.transition[one.transition].fire(cx, marking, one.transition, binding);
}

int main(int argc, char **argv)
{
    if ((argc != 3) && (argc != 4)) {
        return 2;
    }
    const uint64_t seed = strtoull(argv[1], NULL, 10);
    const uint64_t steps = strtoull(argv[2], NULL, 10);
    void *marking = calloc(1U, pn_net.marking_size);
    void *copy = calloc(1U, pn_net.marking_size);
    void *binding = calloc(1U, pn_binding_size(&pn_net));
    if ((marking == NULL) || (copy == NULL) || (binding == NULL)) {
        return 2;
    }
    pn_arena_t arena;
    pn_ctx_t cx;
    const size_t size = (argc == 4) ? (size_t)strtoull(argv[3], NULL, 10) : sizeof s_memory;
    pn_arena_init(&arena, s_memory, (size < sizeof s_memory) ? size : sizeof s_memory);
    pn_ctx_init(&cx, &arena, seed);
    if (pn_marking_init(&pn_net, &cx, marking)) {
        for (uint64_t i = 0U; (i <= steps) && step(&cx, marking, copy, binding); i++) {
            /* everything is done by step */
        }
    }
    if (!pn_ok(&cx)) {
        (void)printf("{\"error\": \"%s\", \"where\": \"%s\"}\n", cx.error_name, cx.error_origin);
    }
    free(marking);
    free(copy);
    free(binding);
    return 0;
}
