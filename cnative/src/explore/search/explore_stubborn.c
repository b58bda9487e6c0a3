/* SPDX-License-Identifier: MIT
 * explore_stubborn.c - of the elements that are enabled in a state, those that have to be looked at so that no dead
 * state is missed.
 *
 * A stubborn set for the question where a state is dead. Something is enabled here that is not enabled in a dead state:
 * every way there has an element in it that takes some of its tokens. With these the set begins; then it is closed, so
 * that nothing outside can enable a disabled element of the set, and so that an enabled one can as well occur before as
 * after what is outside:
 *
 * - with a disabled one all those belong to the set that can end one reason for its being disabled,
 * - with an enabled one, for each of its counters: all those with which it does not commute, or all those that put
 * tokens there (then what is outside only takes some, and if enough are left in the end, they are now).
 *
 * The first element of the set on a way to a dead state could so occur now. Only useful elements count
 * (src/pn2code/verify/exploring/irrelevant_elements.py): shortest ways have no others in them. For each enabled element
 * a set is closed; the one with the fewest enabled elements is taken.
 */
#include "explore_reduce.h"

#include <string.h>

enum {
    WORK = 1 << 16 /* uses that are looked at in a state after the first set has been found */
};

/* Enabled elements with the same effect, which cannot be told apart. */
typedef struct effect {
    uint64_t hash;
    uint32_t transition;
    uint32_t left; /* that have not come as successors */
    bool is_chosen;
} effect_t;

/* What has been closed for a counter: the same needs not be done again. */
typedef struct closed {
    uint64_t rivals; /* number of the set in which it was, of elements that take `pre` and put `post` */
    uint32_t pre;
    uint32_t post;
    uint64_t helpers; /* number of the set in which those were added that put tokens */
    uint64_t costs;   /* number of the set in which it was worked out what that costs */
    uint64_t cost;
} closed_t;

typedef struct ex_stubborn {
    const ex_reduction_t *reduction;
    uint32_t *value;   /* by counter: tokens */
    uint32_t *enabled; /* elements */
    uint32_t enabled_count;
    uint32_t *effect_of; /* by position in `enabled` */
    effect_t *effect;
    uint32_t effects;
    uint32_t *table; /* hashed: effect + 1 */
    uint32_t table_mask;
    uint64_t *is_enabled; /* bits, by element */
    uint64_t *is_in;      /* the set that is closed */
    uint32_t *set;        /* its elements, in the order in which they came */
    uint32_t set_count;
    uint32_t set_enabled;
    uint32_t *best; /* enabled elements of the best set */
    uint32_t best_count;
    uint64_t *next;   /* packed words */
    closed_t *closed; /* by counter */
    uint64_t sets;    /* that have been begun */
    uint64_t work;
} stubborn_t;

static bool has_bit(const uint64_t *bits, uint32_t i)
{
    return ((bits[i / 64U] >> (i % 64U)) & 1U) != 0U;
}

bool ex_stubborn_make(ex_worker_t *worker, const ex_reduction_t *reduction)
{
    ex_run_t *run = worker->run;
    const uint64_t elements = (uint64_t)reduction->elements + 1U;
    const uint64_t bits = (elements / 64U) + 1U;
    uint32_t slots = 16U;
    while (slots < (2U * elements)) {
        slots *= 2U;
    }
    stubborn_t *own = ex_alloc(&run->memory, sizeof *own);
    if (own == NULL) {
        return false;
    }
    worker->stubborn = own;
    own->reduction = reduction;
    own->table_mask = slots - 1U;
    own->value = ex_alloc(&run->memory, ((uint64_t)reduction->counters + 1U) * sizeof *own->value);
    own->enabled = ex_alloc(&run->memory, elements * sizeof *own->enabled);
    own->effect_of = ex_alloc(&run->memory, elements * sizeof *own->effect_of);
    own->effect = ex_alloc(&run->memory, elements * sizeof *own->effect);
    own->table = ex_alloc(&run->memory, slots * sizeof *own->table);
    own->is_enabled = ex_alloc(&run->memory, bits * sizeof *own->is_enabled);
    own->is_in = ex_alloc(&run->memory, bits * sizeof *own->is_in);
    own->set = ex_alloc(&run->memory, elements * sizeof *own->set);
    own->best = ex_alloc(&run->memory, elements * sizeof *own->best);
    own->closed = ex_alloc(&run->memory, ((uint64_t)reduction->counters + 1U) * sizeof *own->closed);
    own->next = ex_alloc(&run->memory, ((uint64_t)reduction->words + 1U) * sizeof *own->next);
    return (own->value != NULL) && (own->enabled != NULL) && (own->effect_of != NULL) && (own->effect != NULL)
           && (own->table != NULL) && (own->is_enabled != NULL) && (own->is_in != NULL) && (own->set != NULL)
           && (own->best != NULL) && (own->next != NULL) && (own->closed != NULL);
}

/* --- effects ------------------------------------------------------------------------------------------------------ */

static uint64_t mixed(uint64_t a, uint64_t b)
{
    const ex_wide_t wide = (ex_wide_t)(a ^ 0x9e3779b97f4a7c15U) * (b ^ 0xd6e8feb86659fd93U);
    return (uint64_t)wide ^ (uint64_t)(wide >> 64U);
}

static uint64_t hash_of_word(uint32_t word, uint64_t value)
{
    return mixed(mixed(value, word), value);
}

/* The words in which two markings differ, and what they are in the second one. */
static uint64_t hash_of(const uint64_t *from, const uint64_t *to, uint32_t words, uint32_t transition)
{
    uint64_t hash = mixed(transition, transition);
    for (uint32_t w = 0U; w < words; w++) {
        hash += (from[w] != to[w]) ? hash_of_word(w, to[w]) : 0U;
    }
    return hash;
}

/* The same for an element that occurs. */
static uint64_t hash_of_element(stubborn_t *own, const uint64_t *from, const ex_element_t *element)
{
    const ex_reduction_t *reduction = own->reduction;
    uint64_t hash = mixed(element->transition, element->transition);
    for (uint64_t i = element->first; i < element->end; i++) {
        const ex_touch_t *touch = &reduction->touch[i];
        const ex_counter_t *counter = &reduction->counter[touch->other];
        own->next[counter->word] = from[counter->word];
    }
    for (uint64_t i = element->first; i < element->end; i++) {
        const ex_touch_t *touch = &reduction->touch[i];
        const ex_counter_t *counter = &reduction->counter[touch->other];
        uint64_t change = (uint64_t)touch->post - touch->pre;
        if (touch->is_reset) {
            change = 0U - (uint64_t)own->value[touch->other];
        }
        own->next[counter->word] += change << counter->shift;
    }
    for (uint64_t i = element->first; i < element->end; i++) {
        const uint32_t w = reduction->counter[reduction->touch[i].other].word;
        if (own->next[w] != from[w]) {
            hash += hash_of_word(w, own->next[w]);
            own->next[w] = from[w]; /* counts once */
        }
    }
    return hash;
}

/* The slot of an effect in the table; of a free one if there is none. */
static uint32_t *find_effect(stubborn_t *own, uint64_t hash, uint32_t transition)
{
    uint32_t at = (uint32_t)(hash >> 32U) & own->table_mask;
    while (own->table[at] != 0U) {
        const effect_t *effect = &own->effect[own->table[at] - 1U];
        if ((effect->hash == hash) && (effect->transition == transition)) {
            break;
        }
        at = (at + 1U) & own->table_mask;
    }
    return &own->table[at];
}

static void forget_effects(stubborn_t *own)
{
    for (uint32_t i = 0U; i < own->effects; i++) {
        uint32_t at = (uint32_t)(own->effect[i].hash >> 32U) & own->table_mask;
        while (own->table[at] != 0U) {
            own->table[at] = 0U;
            at = (at + 1U) & own->table_mask;
        }
    }
    own->effects = 0U;
}

static void enter_effect(stubborn_t *own, uint32_t position, const uint64_t *packed)
{
    const ex_element_t *element = &own->reduction->element[own->enabled[position]];
    const uint64_t hash = hash_of_element(own, packed, element);
    uint32_t *slot = find_effect(own, hash, element->transition);
    if (*slot == 0U) {
        own->effect[own->effects] = (effect_t){ .hash = hash, .transition = element->transition };
        own->effects++;
        *slot = own->effects;
    }
    own->effect[*slot - 1U].left++;
    own->effect_of[position] = *slot - 1U;
}

/* --- closing ------------------------------------------------------------------------------------------------------ */

static bool is_enabled(const stubborn_t *own, const ex_element_t *element)
{
    for (uint64_t i = element->first; i < element->end; i++) {
        const ex_touch_t *touch = &own->reduction->touch[i];
        const uint32_t value = own->value[touch->other];
        if ((value < touch->pre) || (touch->is_inhibitor && (value > 0U))) {
            return false;
        }
    }
    return true;
}

static void add(stubborn_t *own, uint32_t e)
{
    if (has_bit(own->is_in, e)) {
        return;
    }
    own->is_in[e / 64U] |= (uint64_t)1U << (e % 64U);
    own->set[own->set_count++] = e;
    own->set_enabled += has_bit(own->is_enabled, e) ? 1U : 0U;
}

/* Whether two elements that are both enabled might not both occur, in either order and with the same result, because of
 * a counter. */
static bool is_conflict(const ex_touch_t *a, const ex_touch_t *b)
{
    if (a->is_reset || b->is_reset) {
        return true;
    }
    if ((a->is_inhibitor && (b->post > 0U)) || (b->is_inhibitor && (a->post > 0U))) {
        return true;
    }
    const uint32_t least_post = (a->post < b->post) ? a->post : b->post;
    const uint32_t least_pre = (a->pre < b->pre) ? a->pre : b->pre;
    return least_post < least_pre;
}

/* Whether an element can end the reason for which another is disabled: too few tokens, or (is_inhibitor) some. */
static bool is_helper(const ex_touch_t *use, uint32_t value, bool is_inhibitor)
{
    if (!use->is_useful) {
        return false;
    }
    if (is_inhibitor) {
        return use->is_reset || (use->pre > use->post);
    }
    return !use->is_reset && (use->post > use->pre) && (use->pre <= value);
}

static uint64_t cost_of(const stubborn_t *own, uint32_t e)
{
    if (has_bit(own->is_in, e)) {
        return 0U;
    }
    return has_bit(own->is_enabled, e) ? ((uint64_t)1U << 24U) : 1U;
}

/* Whether an element may put tokens on a counter, or look at them while they are not taken: what must not be outside
 * for the second kind of closing. */
static bool is_putting(const ex_touch_t *use)
{
    return (use->post > 0U) || use->is_reset || use->is_inhibitor;
}

/* An enabled element and one of its counters. */
static void add_rivals(stubborn_t *own, uint32_t e, const ex_touch_t *touch)
{
    const ex_reduction_t *reduction = own->reduction;
    const ex_counter_t *counter = &reduction->counter[touch->other];
    const bool is_plain = !touch->is_reset && !touch->is_inhibitor;
    const bool has_choice = (touch->pre > 0U) && is_plain;
    closed_t *closed = &own->closed[touch->other];
    if (is_plain && (closed->rivals == own->sets) && (closed->pre == touch->pre) && (closed->post == touch->post)) {
        return; /* they conflict with the same ones, and are in the set themselves */
    }
    if (is_plain) {
        closed->rivals = own->sets;
        closed->pre = touch->pre;
        closed->post = touch->post;
    }
    uint64_t conflicts = 0U;
    uint64_t putting = 0U;
    own->work += counter->end - counter->first;
    for (uint64_t k = counter->first; k < counter->end; k++) {
        const ex_touch_t *use = &reduction->use[k];
        if (use->is_useful && (use->other != e)) {
            conflicts += is_conflict(touch, use) ? cost_of(own, use->other) : 0U;
            putting += is_putting(use) ? cost_of(own, use->other) : 0U;
        }
    }
    const bool takes_putting = has_choice && (putting < conflicts);
    for (uint64_t k = counter->first; k < counter->end; k++) {
        const ex_touch_t *use = &reduction->use[k];
        if (use->is_useful && (takes_putting ? is_putting(use) : is_conflict(touch, use))) {
            add(own, use->other);
        }
    }
}

static void add_conflicts(stubborn_t *own, uint32_t e)
{
    const ex_element_t *element = &own->reduction->element[e];
    for (uint64_t i = element->first; i < element->end; i++) {
        add_rivals(own, e, &own->reduction->touch[i]);
    }
}

/* What can disable an enabled element: what takes from its counters, or puts where none must be. */
static void add_disabling(stubborn_t *own, uint32_t e)
{
    const ex_reduction_t *reduction = own->reduction;
    for (uint64_t i = reduction->element[e].first; i < reduction->element[e].end; i++) {
        const ex_touch_t *touch = &reduction->touch[i];
        const ex_counter_t *counter = &reduction->counter[touch->other];
        own->work += counter->end - counter->first;
        for (uint64_t k = counter->first; k < counter->end; k++) {
            const ex_touch_t *use = &reduction->use[k];
            const bool is_less = (touch->pre > 0U) && (use->is_reset || (use->pre > use->post));
            const bool is_more = touch->is_inhibitor && (use->post > use->pre);
            if (use->is_useful && (is_less || is_more)) {
                add(own, use->other);
            }
        }
    }
}

/* What it costs to take this reason. */
static uint64_t cost_of_reason(stubborn_t *own, const ex_touch_t *touch, bool is_inhibitor)
{
    const ex_reduction_t *reduction = own->reduction;
    const ex_counter_t *counter = &reduction->counter[touch->other];
    const uint32_t value = own->value[touch->other];
    uint64_t cost = 0U;
    closed_t *closed = &own->closed[touch->other];
    if (!is_inhibitor && (closed->helpers == own->sets)) {
        return 0U;
    }
    if (!is_inhibitor && (closed->costs == own->sets)) {
        return closed->cost; /* or less by now */
    }
    own->work += counter->end - counter->first;
    for (uint64_t k = counter->first; k < counter->end; k++) {
        const ex_touch_t *use = &reduction->use[k];
        if (is_helper(use, value, is_inhibitor)) {
            cost += cost_of(own, use->other);
        }
    }
    if (!is_inhibitor) {
        closed->costs = own->sets;
        closed->cost = cost;
    }
    return cost;
}

static void add_helpers(stubborn_t *own, uint32_t e)
{
    const ex_reduction_t *reduction = own->reduction;
    const ex_touch_t *reason = NULL;
    bool is_reason_inhibitor = false;
    uint64_t least = UINT64_MAX;
    for (uint64_t i = reduction->element[e].first; (least > 0U) && (i < reduction->element[e].end); i++) {
        const ex_touch_t *touch = &reduction->touch[i];
        const bool is_short = own->value[touch->other] < touch->pre;
        const bool is_inhibited = touch->is_inhibitor && (own->value[touch->other] > 0U);
        if (!is_short && !is_inhibited) {
            continue;
        }
        const uint64_t cost = cost_of_reason(own, touch, !is_short);
        if (cost < least) {
            least = cost;
            reason = touch;
            is_reason_inhibitor = !is_short;
        }
    }
    if ((reason == NULL) || (least == 0U)) {
        return;
    }
    const ex_counter_t *counter = &reduction->counter[reason->other];
    const uint32_t value = own->value[reason->other];
    if (!is_reason_inhibitor) {
        own->closed[reason->other].helpers = own->sets;
    }
    for (uint64_t k = counter->first; k < counter->end; k++) {
        if (is_helper(&reduction->use[k], value, is_reason_inhibitor)) {
            add(own, reduction->use[k].other);
        }
    }
}

/* Closes a set for an enabled element. False: given up, as it is not better than the best one. */
static bool close_for(stubborn_t *own, uint32_t enabled)
{
    const bool is_first = own->best_count == UINT32_MAX;
    own->set_count = 0U;
    own->set_enabled = 0U;
    own->sets++;
    add_disabling(own, enabled);
    for (uint32_t i = 0U; (i < own->set_count) && (own->set_enabled < own->best_count); i++) {
        const uint32_t e = own->set[i];
        if (has_bit(own->is_enabled, e)) {
            add_conflicts(own, e);
        } else {
            add_helpers(own, e);
        }
        if (!is_first && (own->work > (uint64_t)WORK)) {
            break;
        }
    }
    const bool is_better = (own->set_enabled < own->best_count) && (is_first || (own->work <= (uint64_t)WORK));
    if (is_better) {
        own->best_count = 0U;
        for (uint32_t i = 0U; i < own->set_count; i++) {
            if (has_bit(own->is_enabled, own->set[i])) {
                own->best[own->best_count++] = own->set[i];
            }
        }
    }
    for (uint32_t i = 0U; i < own->set_count; i++) {
        own->is_in[own->set[i] / 64U] &= ~((uint64_t)1U << (own->set[i] % 64U));
    }
    return is_better;
}

void ex_stubborn_begin(ex_worker_t *worker)
{
    stubborn_t *own = worker->stubborn;
    const ex_reduction_t *reduction = own->reduction;
    const uint64_t *packed = worker->marking;
    for (uint32_t i = 0U; i < own->enabled_count; i++) {
        own->is_enabled[own->enabled[i] / 64U] = 0U;
    }
    own->enabled_count = 0U;
    forget_effects(own);
    for (uint32_t c = 0U; c < reduction->counters; c++) {
        own->value[c] = ex_count_of(&reduction->counter[c], packed);
    }
    for (uint32_t e = 0U; e < reduction->elements; e++) {
        if (is_enabled(own, &reduction->element[e])) {
            own->is_enabled[e / 64U] |= (uint64_t)1U << (e % 64U);
            own->enabled[own->enabled_count] = e;
            enter_effect(own, own->enabled_count, packed);
            own->enabled_count++;
        }
    }
    own->best_count = UINT32_MAX;
    own->work = 0U;
    for (uint32_t i = 0U; (i < own->enabled_count) && (own->best_count > 0U); i++) {
        (void)close_for(own, own->enabled[i]);
        if (own->work > (uint64_t)WORK) {
            break;
        }
    }
    uint32_t at = 0U;
    for (uint32_t i = 0U; (own->best_count != UINT32_MAX) && (i < own->best_count); i++) {
        own->is_in[own->best[i] / 64U] |= (uint64_t)1U << (own->best[i] % 64U);
    }
    for (; at < own->enabled_count; at++) {
        if (has_bit(own->is_in, own->enabled[at])) {
            own->effect[own->effect_of[at]].is_chosen = true;
        }
    }
    for (uint32_t i = 0U; (own->best_count != UINT32_MAX) && (i < own->best_count); i++) {
        own->is_in[own->best[i] / 64U] = 0U;
    }
}

bool ex_stubborn_takes(ex_worker_t *worker, uint32_t transition, const void *next, bool *is_known)
{
    stubborn_t *own = worker->stubborn;
    const uint64_t hash = hash_of(worker->marking, next, own->reduction->words, transition);
    const uint32_t slot = *find_effect(own, hash, transition);
    *is_known = (slot != 0U) && (own->effect[slot - 1U].left > 0U);
    if (!*is_known) {
        return false;
    }
    own->effect[slot - 1U].left--;
    return own->effect[slot - 1U].is_chosen;
}

bool ex_stubborn_is_even(const ex_worker_t *worker)
{
    const stubborn_t *own = worker->stubborn;
    for (uint32_t i = 0U; i < own->effects; i++) {
        if (own->effect[i].left > 0U) {
            return false;
        }
    }
    return true;
}
