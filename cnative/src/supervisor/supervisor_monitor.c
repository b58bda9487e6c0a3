/* SPDX-License-Identifier: MIT
 * supervisor_monitor.c - with -DPN_MONITOR: every step is checked against the rules of the net while the cell runs; the
 * first that breaks one stops it safely. Without it, nothing of this is compiled.
 *
 * Rules that are checked:
 *
 *   before an occurrence   no place and no reference has changed since the step before; the transition is one of this
 *                          program's; it is enabled with this binding; nothing of this program with a higher priority
 *                          is enabled
 *   after it               only places that the transition touches have changed (that none holds more than it may is
 *                          always checked), references only if it assigns some
 *   after messages         only channels of that direction have changed; none holds more than one token; no reference
 *                          has changed
 *
 * They hold in a program that is compiled right, on a machine that works: what the monitor finds is memory that
 * something has overwritten, a compiler that is wrong, a file of the net that was edited. It remembers a checksum of
 * each place, and one of all that the references hold which the net assigns.
 */
#include "supervisor_impl.h"

#ifdef PN_MONITOR

#include <stdlib.h>
#include <string.h>

#include "pn/pn_root.h"

#define PLACE_SIZE ((size_t)1U << 20U) /* bytes of the canonical form of a place */
#define TEXT_SIZE  ((size_t)1U << 16U) /* bytes of a binding as text */

static struct {
    uint64_t *checksum;  /* for each place */
    uint64_t references; /* the checksum of what they hold */
    bool has_references; /* which only occurrences assign */
    pn_time_t now;
    uint8_t bytes[PLACE_SIZE];
    char wanted[TEXT_SIZE];
    char found[TEXT_SIZE];
} s_monitor;

/* FNV-1a. */
static uint64_t checksum_of(const uint8_t *bytes, size_t length)
{
    uint64_t sum = UINT64_C(0xCBF29CE484222325);
    for (size_t i = 0U; i < length; i++) {
        sum = (sum ^ bytes[i]) * UINT64_C(0x100000001B3);
    }
    return sum;
}

/* Sets *changed and remembers what the place holds now. False: it cannot be looked at. */
static bool look(sup_t *sup, uint32_t index, bool *changed)
{
    const pn_place_t *const place = &sup->net->place[index];
    const size_t length = pn_multiset_encode(place->multiset, sup->marking, s_monitor.bytes, PLACE_SIZE);
    if (length > PLACE_SIZE) {
        return sup_stop(sup, SUP_EXIT_MODEL, "monitor: the content of place `%s` is too large to be checked",
                        place->name);
    }
    const uint64_t sum = checksum_of(s_monitor.bytes, length);
    *changed = (sum != s_monitor.checksum[index]);
    s_monitor.checksum[index] = sum;
    return true;
}

/* The same of what references hold. */
static bool look_at_references(sup_t *sup, bool *changed)
{
    *changed = false;
    if (!s_monitor.has_references) {
        return true;
    }
    const size_t length = pn_roots_encode(sup->net->root, sup->net->root_count, s_monitor.bytes, PLACE_SIZE);
    if (length > PLACE_SIZE) {
        return sup_stop(sup, SUP_EXIT_MODEL, "monitor: the values of the references are too large to be checked");
    }
    const uint64_t sum = checksum_of(s_monitor.bytes, length);
    *changed = (sum != s_monitor.references);
    s_monitor.references = sum;
    return true;
}

/* Whether references are as they were before; `what` has changed them if they are not. */
static bool keeps_references(sup_t *sup, const char *what, const char *name)
{
    bool changed = false;
    return look_at_references(sup, &changed)
           && (!changed
               || sup_stop(sup, SUP_EXIT_INTERNAL, "monitor: the values of references have changed %s%s", what, name));
}

bool sup_monitor_start(sup_t *sup)
{
    bool is_fine = true;
    bool is_assigned_in_search = false;
    for (uint32_t i = 0U; i < sup->net->transition_count; i++) {
        is_assigned_in_search = is_assigned_in_search || sup->net->transition[i].search_assigns;
    }
    s_monitor.has_references = (sup->net->root_count > 0U) && !is_assigned_in_search;
    s_monitor.checksum = calloc((size_t)sup->net->place_count + 1U, sizeof *s_monitor.checksum);
    if (s_monitor.checksum == NULL) {
        return sup_stop(sup, SUP_EXIT_IO, "not enough memory");
    }
    for (uint32_t i = 0U; is_fine && (i < sup->net->place_count); i++) {
        bool changed = false;
        is_fine = look(sup, i, &changed);
    }
    bool changed = false;
    is_fine = is_fine && look_at_references(sup, &changed);
    sup_say(sup, 1, "monitor: every step is checked against the rules of the net");
    return is_fine;
}

/* --- before an occurrence ----------------------------------------------------------------------------------------- */

typedef struct search {
    const pn_transition_t *transition;
    bool is_found;
} search_t;

static bool is_wanted(void *user, uint32_t index, const void *binding)
{
    search_t *const search = user;
    pn_text_t text;
    (void)index;
    pn_text_init(&text, s_monitor.found, TEXT_SIZE);
    pn_json(search->transition->binding, binding, &text);
    search->is_found = (strcmp(s_monitor.found, s_monitor.wanted) == 0);
    return !search->is_found;
}

static bool is_any(void *user, uint32_t index, const void *binding)
{
    (void)index;
    (void)binding;
    ((search_t *)user)->is_found = true;
    return false;
}

static bool has_binding(sup_t *sup, uint32_t index, pn_binding_sink_t sink)
{
    search_t search = { .transition = &sup->net->transition[index], .is_found = false };
    const size_t mark = pn_arena_mark(&sup->arena);
    (void)search.transition->enumerate(&sup->cx, sup->marking, index, sink, &search);
    pn_arena_release(&sup->arena, mark);
    return search.is_found;
}

bool sup_monitor_choice(sup_t *sup, int32_t owner, uint32_t index)
{
    const pn_transition_t *const t = &sup->net->transition[index];
    pn_text_t text;
    for (uint32_t i = 0U; i < sup->net->place_count; i++) {
        bool changed = false;
        if (!look(sup, i, &changed)) {
            return false;
        }
        if (changed) {
            return sup_stop(sup, SUP_EXIT_INTERNAL, "monitor: place `%s` has changed between two steps",
                            sup->net->place[i].name);
        }
    }
    if (!keeps_references(sup, "between two steps", "")) {
        return false;
    }
    if ((owner >= 0) && (t->owner != owner)) {
        return sup_stop(sup, SUP_EXIT_INTERNAL, "monitor: `%s` is not a transition of this program", t->name);
    }
    if (t->looks) {
        return true; /* a second search may find something else */
    }
    pn_text_init(&text, s_monitor.wanted, TEXT_SIZE);
    pn_json(t->binding, sup->binding, &text);
    if (!has_binding(sup, index, is_wanted)) {
        return sup_stop(sup, SUP_EXIT_INTERNAL, "monitor: `%s` is not enabled with %s", t->name, s_monitor.wanted);
    }
    for (uint32_t k = 0U; k < sup->net->order_count; k++) {
        const pn_transition_t *const other = &sup->net->transition[sup->net->order[k]];
        const bool is_mine = (owner < 0) || (other->owner == owner);
        if (is_mine && (other->priority < t->priority) && !other->looks
            && has_binding(sup, sup->net->order[k], is_any)) {
            return sup_stop(sup, SUP_EXIT_INTERNAL, "monitor: `%s` is enabled and has a higher priority than `%s`",
                            other->name, t->name);
        }
    }
    return true;
}

/* --- after it ----------------------------------------------------------------------------------------------------- */

static bool touches(const pn_transition_t *t, uint32_t place)
{
    for (uint32_t i = 0U; i < t->touched_count; i++) {
        if (t->touched[i] == place) {
            return true;
        }
    }
    return t->touched == NULL;
}

bool sup_monitor_step(sup_t *sup, uint32_t index)
{
    const pn_transition_t *const t = &sup->net->transition[index];
    for (uint32_t i = 0U; i < sup->net->place_count; i++) {
        bool changed = false;
        if (!look(sup, i, &changed)) {
            return false;
        }
        if (changed && !touches(t, i)) {
            return sup_stop(sup, SUP_EXIT_INTERNAL, "monitor: `%s` has changed place `%s`, with which it has no arc",
                            t->name, sup->net->place[i].name);
        }
    }
    bool changed = false;
    return t->assigns ? look_at_references(sup, &changed)
                      : keeps_references(sup, "although nothing assigns any in ", t->name);
}

/* --- messages ----------------------------------------------------------------------------------------------------- */

static bool is_channel(const sup_t *sup, uint32_t place, pn_channel_direction_t direction)
{
    for (uint32_t i = 0U; i < sup->cell->channel_count; i++) {
        if ((sup->cell->channel[i].place == place) && (sup->cell->channel[i].direction == direction)) {
            return true;
        }
    }
    return false;
}

bool sup_monitor_messages(sup_t *sup, pn_channel_direction_t direction)
{
    for (uint32_t i = 0U; i < sup->net->place_count; i++) {
        const pn_place_t *const place = &sup->net->place[i];
        bool changed = false;
        if (!look(sup, i, &changed)) {
            return false;
        }
        if (changed && !is_channel(sup, i, direction)) {
            return sup_stop(sup, SUP_EXIT_INTERNAL, "monitor: place `%s` has changed while messages were exchanged",
                            place->name);
        }
        if (changed && (pn_multiset_total(place->multiset, sup->marking) > 1U)) {
            return sup_stop(sup, SUP_EXIT_INTERNAL, "monitor: channel `%s` holds more than one message", place->name);
        }
    }
    return keeps_references(sup, "while messages were exchanged", "");
}

#endif /* PN_MONITOR */
