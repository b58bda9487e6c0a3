/* SPDX-License-Identifier: MIT
 * supervisor_play.c - firing: step 2 of docs/execution.md.
 */
#include "supervisor_impl.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "pn/pn_port.h"

static const char *error_words(pn_error_t error)
{
    const char *words = "error";
    switch (error) {
    case PN_OK: words = "no error"; break;
    case PN_ERR_OVERFLOW: words = "a number is too large"; break;
    case PN_ERR_DIV: words = "division by zero"; break;
    case PN_ERR_MATCH: words = "no rule fits the value"; break;
    case PN_ERR_BIND: words = "a value does not fit its pattern"; break;
    case PN_ERR_SUBSCRIPT: words = "an index is out of range"; break;
    case PN_ERR_EMPTY: words = "the list is empty"; break;
    case PN_ERR_DOMAIN: words = "a value is out of the function's domain"; break;
    case PN_ERR_COLOUR: words = "a value is not in the colour set"; break;
    case PN_ERR_CAPACITY: words = "the place is full"; break;
    case PN_ERR_MEMORY: words = "the memory for lists and strings is used up"; break;
    case PN_ERR_DEPTH: words = "the recursion is too deep"; break;
    case PN_ERR_SUBTRACT: words = "more tokens are taken than there are"; break;
    case PN_ERR_RAISED: words = "an exception of the net"; break;
    case PN_ERR_ENDLESS: words = "an evaluation does not come to an end"; break;
    case PN_ERR_LARGE: words = "a model time is beyond 64 bits"; break;
    case PN_ERR_UNSUPPORTED: words = "a function is not available here"; break;
    case PN_ERR_INTERNAL: words = "internal error of the runtime"; break;
    default: break;
    }
    return words;
}

bool sup_stop_error(sup_t *sup, const char *doing)
{
    const pn_ctx_t *const cx = &sup->cx;
    const sup_exit_t code = (cx->error == PN_ERR_INTERNAL) ? SUP_EXIT_INTERNAL : SUP_EXIT_MODEL;
    /* Before the first element of the net is evaluated there is none to name. */
    const char *const where = (cx->error_origin[0] != '\0') ? cx->error_origin : sup->net->source;
    if (cx->error == PN_ERR_CAPACITY) {
        return sup_stop(sup, code, "%s: %s (the head of net.c says for how many tokens it has room), while %s", where,
                        error_words(cx->error), doing);
    }
    if (cx->error_name == cx->said) { /* a sentence of its own, with the value */
        return sup_stop(sup, code, "%s: %s, while %s", where, cx->error_name, doing);
    }
    return sup_stop(sup, code, "%s: %s (`%s`), while %s", where, error_words(cx->error), cx->error_name, doing);
}

/* Keeps the first binding of an enumeration. */
typedef struct first_binding {
    void *binding;
    size_t size;
    bool found;
} first_binding_t;

static bool keep_first(void *user, uint32_t transition, const void *binding)
{
    first_binding_t *const first = user;
    (void)transition;
    (void)memcpy(first->binding, binding, first->size);
    first->found = true;
    return false;
}

/* Whether no place has more tokens than its bound. Those of channels are looked at when they are published (I3). */
static bool keeps_bounds(sup_t *sup, const pn_transition_t *fired)
{
    for (uint32_t k = 0U; k < fired->touched_count; k++) {
        const pn_place_t *const place = &sup->net->place[fired->touched[k]];
        if (!place->is_bounded || (place->owner < 0)) {
            continue;
        }
        const uint64_t tokens = pn_multiset_total(place->multiset, sup->marking);
        if (tokens > (uint64_t)place->bound) {
            return sup_stop(sup, SUP_EXIT_MODEL,
                            "place `%s` is full: it would hold %" PRIu64 " tokens after `%s`, and its bound is %" PRIu32
                            " (the head of net.c says why)",
                            place->name, tokens, fired->name, place->bound);
        }
    }
    return true;
}

/* Forgets what only the last firings needed. */
static bool make_room(sup_t *sup)
{
    if (!pn_arena_is_crowded(&sup->arena)) {
        return true;
    }
    if (sup->cell->needs.collect == NULL) {
        pn_arena_flip(&sup->arena); /* nothing refers into it */
        return true;
    }
    sup->cell->needs.collect(sup->net, &sup->cx, sup->marking);
    if (sup->cx.error != PN_OK) {
        return sup_stop_error(sup, "making room between firings");
    }
    return true;
}

int sup_find_one(sup_t *sup, int32_t owner, uint32_t *transition)
{
    const pn_net_t *const net = sup->net;
    char doing[512];
    first_binding_t first = { sup->binding, 0U, false };
    uint32_t i = 0U;
    while ((i < net->order_count) && !first.found) {
        const uint32_t index = net->order[i];
        const pn_transition_t *const candidate = &net->transition[index];
        i++;
        if ((owner >= 0) && (candidate->owner != owner)) {
            continue;
        }
        first.size = candidate->binding->size;
        *transition = index;
        (void)candidate->enumerate(&sup->cx, sup->marking, index, keep_first, &first);
        if (sup->cx.error != PN_OK) {
            (void)snprintf(doing, sizeof doing, "looking for bindings of `%s`", candidate->name);
            (void)sup_stop_error(sup, doing);
            return -1;
        }
    }
    return first.found ? 1 : 0;
}

int sup_fire_one(sup_t *sup, int32_t owner, uint32_t *transition)
{
    char doing[512];
    uint32_t index = 0U;
    const int found = sup_find_one(sup, owner, &index);
    if (found <= 0) {
        return found;
    }
    const pn_transition_t *const chosen = &sup->net->transition[index];
    if (!sup_monitor_choice(sup, owner, index)) {
        return -1;
    }
    sup->cx.step = sup->fired + 1U; /* an occurrence counts itself, as in CPN Tools; a search does not */
    if (!chosen->fire(&sup->cx, sup->marking, index, sup->binding)) {
        (void)snprintf(doing, sizeof doing, "firing `%s`", chosen->name);
        (void)sup_stop_error(sup, doing);
        return -1;
    }
    if (!keeps_bounds(sup, chosen) || !sup_monitor_step(sup, index)) {
        return -1;
    }
    sup_trace_occurrence(sup, index);
    if (!make_room(sup)) {
        return -1;
    }
    sup->fired++;
    sup->cx.step = sup->fired;
    sup->fired_of[index]++;
    *transition = index;
    return 1;
}

bool sup_play(sup_t *sup, int32_t owner, uint64_t *count)
{
    uint32_t transition = 0U;
    int result = 1;
    *count = 0U;
    while (result > 0) {
        if (pn_port_stop_signal() != 0) {
            return sup_stop(sup, SUP_EXIT_INTERRUPTED, "interrupted by signal %d", pn_port_stop_signal());
        }
        result = sup_fire_one(sup, owner, &transition);
        if (result > 0) {
            (*count)++;
            if (*count >= sup->options.max_firings) {
                result = sup_fire_one(sup, owner, &transition);
                if (result > 0) {
                    (void)sup_stop(sup, SUP_EXIT_MODEL,
                                   "no end of firing: after %" PRIu64 " firings in one cycle `%s` is still enabled; "
                                   "a supervisor must come to rest (--max-firings N allows more)",
                                   *count, sup->net->transition[transition].name);
                    result = -1;
                }
            }
        }
    }
    return result == 0;
}

void sup_set_time(sup_t *sup, double t)
{
    if (!sup->net->timed) {
        return;
    }
    const pn_time_t now = pn_now(sup->net, sup->marking);
    const double scaled = t * sup->options.time_scale;
    pn_time_t next = now;
    if (sup->net->real_time) {
        next.real = (scaled > now.real) ? scaled : now.real;
    } else {
        /* 2.9999999996 is the time 3 that sup_next_time named, turned into seconds and back */
        const double whole = floor(scaled + 1e-9 * fmax(1.0, fabs(scaled)));
        const int64_t integer = (whole < 9.0e18) ? (int64_t)whole : INT64_MAX;
        next.integer = (integer > now.integer) ? integer : now.integer;
    }
    pn_set_now(sup->net, sup->marking, next);
}

bool sup_next_time(sup_t *sup, double *t)
{
    pn_time_t next;
    if ((sup->cell->needs.next_time == NULL) || !sup->cell->needs.next_time(sup->net, &sup->cx, sup->marking, &next)) {
        if (sup->cx.error != PN_OK) {
            (void)sup_stop_error(sup, "looking for the next time");
        }
        return false;
    }
    *t = (sup->net->real_time ? next.real : (double)next.integer) / sup->options.time_scale;
    return true;
}

bool sup_is_final(const sup_t *sup)
{
    for (uint32_t i = 0U; i < sup->cell->final_count; i++) {
        if (pn_multiset_total(sup->net->place[sup->cell->final_place[i]].multiset, sup->marking) > 0U) {
            return true;
        }
    }
    return false;
}

void sup_final_places(const sup_t *sup, pn_text_t *text)
{
    bool is_first = true;
    for (uint32_t i = 0U; i < sup->cell->final_count; i++) {
        const pn_place_t *const place = &sup->net->place[sup->cell->final_place[i]];
        if (pn_multiset_total(place->multiset, sup->marking) == 0U) {
            continue;
        }
        if (!is_first) {
            pn_text_str(text, ", ");
        }
        is_first = false;
        pn_text_str(text, place->name);
    }
}

const char *sup_token_text(const sup_t *sup, const pn_cell_channel_t *channel, char *out, size_t capacity)
{
    pn_scalar_value_t scalar_value[PN_CHANNEL_SCALARS];
    const uint32_t count =
        pn_multiset_token(sup->net->place[channel->place].multiset, sup->marking, 0U, scalar_value, PN_CHANNEL_SCALARS);
    if ((count == 0U)
        || (pn_scalars_format(channel->scalar, channel->scalar_count, scalar_value, out, capacity) == 0U)) {
        (void)snprintf(out, capacity, "?");
    }
    return out;
}
