/* SPDX-License-Identifier: MIT
 * explore_symmetry.c - one marking for all that are the same but for the names of colours: the greatest one among those
 * that are looked at, which is exactly the same for each member of the orbit.
 *
 * Rotations are all tried. For exchanges, points (colours) are told apart by what the marking says of them: classes are
 * refined until they are stable, and where points are left that look the same, one is made the first of its class, each
 * in turn, unless it is known that this leads to the same (points whose exchange leaves the marking as it is; points
 * whose first leaf is one that is known).
 */
#include "explore_instances.h"
#include "explore_reduce.h"

#include <string.h>

enum {
    KEPT_LEAVES = 4 /* of a node of the search tree, to compare others with */
};

typedef struct ex_symmetry {
    const ex_reduction_t *reduction;
    uint32_t *value;  /* by counter: the marking that is looked at */
    uint32_t *turned; /* the same after rotations */
    uint32_t *best;
    bool has_best;
    uint32_t *leaf; /* the last leaf */
    uint32_t *held; /* counters of `turned` that are not 0 */
    uint32_t held_count;
    uint32_t *kept;    /* leaves, KEPT_LEAVES for each depth */
    uint32_t *rank;    /* by depth and point: number of points in lower classes */
    uint64_t *mark;    /* by point: what the marking says of it */
    uint32_t *order;   /* points */
    uint32_t *image;   /* by point */
    uint32_t *tried;   /* by depth: points of the class that have been made the first */
    uint64_t *marking; /* the result */
} symmetry_t;

bool ex_symmetry_make(ex_worker_t *worker, const ex_reduction_t *reduction)
{
    ex_run_t *run = worker->run;
    const uint64_t counters = (uint64_t)reduction->counters + 1U;
    const uint64_t points = (uint64_t)reduction->exchanges.points + 1U;
    symmetry_t *own = ex_alloc(&run->memory, sizeof *own);
    if (own == NULL) {
        return false;
    }
    worker->symmetry = own;
    own->reduction = reduction;
    own->value = ex_alloc(&run->memory, counters * sizeof(uint32_t));
    own->turned = ex_alloc(&run->memory, counters * sizeof(uint32_t));
    own->best = ex_alloc(&run->memory, counters * sizeof(uint32_t));
    own->leaf = ex_alloc(&run->memory, counters * sizeof(uint32_t));
    own->held = ex_alloc(&run->memory, counters * sizeof(uint32_t));
    own->kept = ex_alloc(&run->memory, points * (uint64_t)KEPT_LEAVES * counters * sizeof(uint32_t));
    own->rank = ex_alloc(&run->memory, points * points * sizeof(uint32_t));
    own->mark = ex_alloc(&run->memory, points * sizeof *own->mark);
    own->order = ex_alloc(&run->memory, points * sizeof(uint32_t));
    own->image = ex_alloc(&run->memory, points * sizeof(uint32_t));
    own->tried = ex_alloc(&run->memory, points * points * sizeof(uint32_t));
    own->marking = ex_alloc(&run->memory, pn_net.marking_size + (2U * sizeof *own->marking));
    return (own->value != NULL) && (own->turned != NULL) && (own->best != NULL) && (own->leaf != NULL)
           && (own->held != NULL) && (own->kept != NULL) && (own->rank != NULL) && (own->mark != NULL)
           && (own->order != NULL) && (own->image != NULL) && (own->tried != NULL) && (own->marking != NULL);
}

static uint64_t mixed(uint64_t a, uint64_t b)
{
    const ex_wide_t wide = (ex_wide_t)(a ^ 0xa0761d6478bd642fU) * (b ^ 0xe7037ed1a0b428dbU);
    return (uint64_t)wide ^ (uint64_t)(wide >> 64U) ^ (a << 1U);
}

/* Keeps a marking if it is greater than the best one, counter by counter. */
static void offer(symmetry_t *own, const uint32_t *value)
{
    const uint32_t counters = own->reduction->counters;
    bool is_better = !own->has_best;
    for (uint32_t c = 0U; !is_better && (c < counters); c++) {
        if (value[c] != own->best[c]) {
            if (value[c] < own->best[c]) {
                return;
            }
            is_better = true;
        }
    }
    if (is_better) {
        own->has_best = true;
        (void)memcpy(own->best, value, counters * sizeof *value);
    }
}

/* --- exchanges: images -------------------------------------------------------------------------------------------- */

static uint64_t hash_of_counter(uint32_t shape, const uint32_t *point, uint64_t count, const uint32_t *image)
{
    uint64_t hash = mixed(shape, 1U);
    for (uint64_t i = 0U; i < count; i++) {
        hash = mixed(hash, (image != NULL) ? image[point[i]] : point[i]);
    }
    return hash;
}

/* The counter that one is mapped to by `image` of the points; UINT32_MAX: there is none. */
static uint32_t image_of(const ex_reduction_t *reduction, uint32_t counter, const uint32_t *image)
{
    const ex_exchanges_t *x = &reduction->exchanges;
    const uint64_t first = x->first[counter];
    const uint64_t count = x->first[counter + 1U] - first;
    uint64_t at = hash_of_counter(x->shape[counter], &x->point[first], count, image) & x->table_mask;
    for (; x->table[at] != 0U; at = (at + 1U) & x->table_mask) {
        const uint32_t other = x->table[at] - 1U;
        const uint64_t begin = x->first[other];
        bool is_it = (x->shape[other] == x->shape[counter]) && ((x->first[other + 1U] - begin) == count);
        for (uint64_t i = 0U; is_it && (i < count); i++) {
            is_it = x->point[begin + i] == image[x->point[first + i]];
        }
        if (is_it) {
            return other;
        }
    }
    return UINT32_MAX;
}

bool ex_exchanges_index(ex_run_t *run, ex_reduction_t *reduction)
{
    ex_exchanges_t *x = &reduction->exchanges;
    uint64_t slots = 16U;
    while (slots < (4U * (uint64_t)reduction->counters)) {
        slots *= 2U;
    }
    x->table_mask = slots - 1U;
    x->table = ex_alloc(&run->memory, slots * sizeof *x->table);
    for (uint32_t c = 0U; (x->table != NULL) && (c < reduction->counters); c++) {
        uint64_t at =
            hash_of_counter(x->shape[c], &x->point[x->first[c]], x->first[c + 1U] - x->first[c], NULL) & x->table_mask;
        while (x->table[at] != 0U) {
            at = (at + 1U) & x->table_mask;
        }
        x->table[at] = c + 1U;
    }
    return x->table != NULL;
}

/* Whether the exchange of two points leaves the marking as it is. */
static bool is_alike(symmetry_t *own, uint32_t a, uint32_t b)
{
    const ex_exchanges_t *x = &own->reduction->exchanges;
    bool is_same = true;
    for (uint32_t p = 0U; p < x->points; p++) {
        own->image[p] = p;
    }
    own->image[a] = b;
    own->image[b] = a;
    for (uint32_t h = 0U; is_same && (h < own->held_count); h++) {
        const uint32_t c = own->held[h];
        bool is_moved = false;
        for (uint64_t i = x->first[c]; i < x->first[c + 1U]; i++) {
            is_moved = is_moved || (x->point[i] == a) || (x->point[i] == b);
        }
        if (is_moved) {
            const uint32_t to = image_of(own->reduction, c, own->image);
            is_same = (to != UINT32_MAX) && (own->turned[to] == own->turned[c]);
        }
    }
    return is_same;
}

/* --- exchanges: classes ------------------------------------------------------------------------------------------- */

/* Adds to the mark of each point what the tokens say of it, as far as it does not depend on the names of points. */
static void mark_points(symmetry_t *own, const uint32_t *rank)
{
    const ex_exchanges_t *x = &own->reduction->exchanges;
    (void)memset(own->mark, 0, x->points * sizeof *own->mark);
    for (uint32_t h = 0U; h < own->held_count; h++) {
        const uint32_t c = own->held[h];
        const uint64_t base = mixed(x->shape[c], own->turned[c]);
        for (uint64_t i = x->first[c]; i < x->first[c + 1U]; i++) {
            uint64_t said = base;
            for (uint64_t k = x->first[c]; k < x->first[c + 1U]; k++) {
                said = mixed(said, ((uint64_t)rank[x->point[k]] * 2U) + ((x->point[k] == x->point[i]) ? 1U : 0U));
            }
            own->mark[x->point[i]] += mixed(said, i - x->first[c]);
        }
    }
}

static bool is_before(const symmetry_t *own, const uint32_t *rank, uint32_t a, uint32_t b)
{
    return (rank[a] != rank[b]) ? (rank[a] < rank[b]) : (own->mark[a] < own->mark[b]);
}

/* Splits classes by the marks. Returns the number of classes. */
static uint32_t split(symmetry_t *own, uint32_t *rank)
{
    const uint32_t points = own->reduction->exchanges.points;
    for (uint32_t p = 0U; p < points; p++) { /* they are few, and nearly sorted from the last time */
        uint32_t at = p;
        for (; (at > 0U) && is_before(own, rank, p, own->order[at - 1U]); at--) {
            own->order[at] = own->order[at - 1U];
        }
        own->order[at] = p;
    }
    uint32_t classes = 0U;
    uint32_t before = 0U; /* rank, as it was, of the point before */
    uint32_t current = 0U;
    for (uint32_t i = 0U; i < points; i++) {
        const uint32_t p = own->order[i];
        const uint32_t was = rank[p];
        if ((i == 0U) || (was != before) || (own->mark[p] != own->mark[own->order[i - 1U]])) {
            current = i;
            classes++;
        }
        before = was;
        rank[p] = current;
    }
    return classes;
}

static uint32_t refine(symmetry_t *own, uint32_t *rank)
{
    uint32_t classes = 0U;
    for (;;) {
        mark_points(own, rank);
        const uint32_t found = split(own, rank);
        if ((found == classes) || (found == own->reduction->exchanges.points)) {
            return found;
        }
        classes = found;
    }
}

/* --- exchanges: search -------------------------------------------------------------------------------------------- */

/* All points are told apart: the marking with the points in this order. */
static void make_leaf(symmetry_t *own, const uint32_t *rank)
{
    const ex_exchanges_t *x = &own->reduction->exchanges;
    (void)memset(own->leaf, 0, own->reduction->counters * sizeof *own->leaf);
    for (uint32_t p = 0U; p < x->points; p++) {
        own->image[p] = x->slot[rank[p]];
    }
    for (uint32_t h = 0U; h < own->held_count; h++) {
        const uint32_t to = image_of(own->reduction, own->held[h], own->image);
        if (to != UINT32_MAX) { /* always: it is a symmetry */
            own->leaf[to] = own->turned[own->held[h]];
        }
    }
}

/* The rank of the first class of several points. */
static uint32_t first_class(const symmetry_t *own, const uint32_t *rank, uint32_t *count)
{
    const uint32_t points = own->reduction->exchanges.points;
    uint32_t least = UINT32_MAX;
    (void)memset(own->order, 0, points * sizeof *own->order);
    for (uint32_t p = 0U; p < points; p++) {
        own->order[rank[p]]++; /* counts, for now */
    }
    for (uint32_t r = 0U; (r < points) && (least == UINT32_MAX); r++) {
        if (own->order[r] > 1U) {
            least = r;
            *count = own->order[r];
        }
    }
    return least;
}

/* Makes a point the first of its class, one level deeper. Returns the number of classes. */
static uint32_t single_out(symmetry_t *own, uint32_t depth, uint32_t point)
{
    const uint32_t points = own->reduction->exchanges.points;
    const uint32_t *rank = &own->rank[(size_t)depth * (points + 1U)];
    uint32_t *deeper = &own->rank[((size_t)depth + 1U) * (points + 1U)];
    for (uint32_t p = 0U; p < points; p++) {
        deeper[p] = ((rank[p] == rank[point]) && (p != point)) ? (rank[p] + 1U) : rank[p];
    }
    return refine(own, deeper);
}

/* Down to a leaf, always with the first point. */
static void first_leaf(symmetry_t *own, uint32_t depth, uint32_t classes)
{
    const uint32_t points = own->reduction->exchanges.points;
    while (classes < points) {
        uint32_t count = 0U;
        const uint32_t *rank = &own->rank[(size_t)depth * (points + 1U)];
        const uint32_t wanted = first_class(own, rank, &count);
        uint32_t point = 0U;
        while (rank[point] != wanted) {
            point++;
        }
        classes = single_out(own, depth, point);
        depth++;
    }
    make_leaf(own, &own->rank[(size_t)depth * (points + 1U)]);
}

/* Whether the last leaf is one of those kept; it is kept if there is room. */
static bool is_known_leaf(symmetry_t *own, uint32_t depth, uint32_t *kept)
{
    const size_t counters = own->reduction->counters;
    uint32_t *leaves = &own->kept[(size_t)depth * (size_t)KEPT_LEAVES * (counters + 1U)];
    for (uint32_t i = 0U; i < *kept; i++) {
        if (memcmp(&leaves[i * counters], own->leaf, counters * sizeof *leaves) == 0) {
            return true;
        }
    }
    if (*kept < (uint32_t)KEPT_LEAVES) {
        (void)memcpy(&leaves[*kept * counters], own->leaf, counters * sizeof *leaves);
        (*kept)++;
    }
    return false;
}

/* Puts the points of a class that are all alike one behind the other: in which order makes no difference. */
static uint32_t single_out_all(symmetry_t *own, uint32_t depth, uint32_t wanted)
{
    const uint32_t points = own->reduction->exchanges.points;
    const uint32_t *rank = &own->rank[(size_t)depth * (points + 1U)];
    uint32_t *deeper = &own->rank[((size_t)depth + 1U) * (points + 1U)];
    uint32_t next = wanted;
    for (uint32_t p = 0U; p < points; p++) {
        deeper[p] = (rank[p] == wanted) ? next : rank[p];
        next += (rank[p] == wanted) ? 1U : 0U;
    }
    return refine(own, deeper);
}

/* Of the points of a class one of each kind of those that are alike; how many. */
static uint32_t list_different(symmetry_t *own, const uint32_t *rank, uint32_t wanted, uint32_t *list)
{
    uint32_t count = 0U;
    for (uint32_t p = 0U; p < own->reduction->exchanges.points; p++) {
        bool is_new = rank[p] == wanted;
        for (uint32_t i = 0U; is_new && (i < count); i++) {
            is_new = !is_alike(own, list[i], p);
        }
        if (is_new) {
            list[count++] = p;
        }
    }
    return count;
}

/* All leaves below a node that may be the best one. Not deeper than there are points. */
static void search(symmetry_t *own, uint32_t depth, uint32_t classes) // NOLINT(misc-no-recursion)
{
    const uint32_t points = own->reduction->exchanges.points;
    const uint32_t *rank = &own->rank[(size_t)depth * (points + 1U)];
    uint32_t *tried = &own->tried[(size_t)depth * (points + 1U)];
    if (classes == points) {
        make_leaf(own, rank);
        offer(own, own->leaf);
        return;
    }
    uint32_t count = 0U;
    uint32_t kept = 0U;
    const uint32_t wanted = first_class(own, rank, &count);
    const uint32_t different = list_different(own, rank, wanted, tried);
    if (different == 1U) {
        search(own, depth + 1U, single_out_all(own, depth, wanted));
        return;
    }
    for (uint32_t i = 0U; i < different; i++) {
        const uint32_t found = single_out(own, depth, tried[i]);
        first_leaf(own, depth + 1U, found);
        if (!is_known_leaf(own, depth, &kept)) {
            (void)single_out(own, depth, tried[i]); /* the levels below were used */
            search(own, depth + 1U, found);
        }
    }
}

/* The best of all exchanges of `turned`. */
static void exchange(symmetry_t *own)
{
    const ex_exchanges_t *x = &own->reduction->exchanges;
    own->held_count = 0U;
    for (uint32_t c = 0U; c < own->reduction->counters; c++) {
        if (own->turned[c] > 0U) {
            own->held[own->held_count++] = c;
        }
    }
    for (uint32_t i = 0U; i < x->points; i++) {
        const uint32_t p = x->slot[i];
        const bool is_first = (i == 0U) || (x->label[x->slot[i - 1U]] != x->label[p]);
        own->rank[p] = is_first ? i : own->rank[x->slot[i - 1U]];
    }
    search(own, 0U, refine(own, own->rank));
}

/* --- rotations ---------------------------------------------------------------------------------------------------- */

/* Puts at each counter's image what is there: value'[permutation[c]] = value[c]. */
static void permute(const uint32_t *permutation, const uint32_t *from, uint32_t *to, uint32_t count)
{
    for (uint32_t c = 0U; c < count; c++) {
        to[permutation[c]] = from[c];
    }
}

/* `turned` after all combinations of rotations from number `group` on. */
static void turn(symmetry_t *own, uint32_t group) // NOLINT(misc-no-recursion)
{
    const ex_reduction_t *reduction = own->reduction;
    const uint32_t counters = reduction->counters;
    if (group == reduction->rotation_count) {
        if (reduction->exchanges.points > 0U) {
            exchange(own);
        } else {
            offer(own, own->turned);
        }
        return;
    }
    const ex_rotations_t *rotations = &reduction->rotations[group];
    const uint32_t sides = (rotations->reflection != NULL) ? 2U : 1U;
    for (uint32_t side = 0U; side < sides; side++) {
        for (uint32_t i = 0U; i < rotations->order; i++) {
            turn(own, group + 1U);
            permute(rotations->rotation, own->turned, own->leaf, counters);
            (void)memcpy(own->turned, own->leaf, counters * sizeof *own->leaf);
        }
        /* After all rotations it is as it was. */
        if (rotations->reflection != NULL) {
            permute(rotations->reflection, own->turned, own->leaf, counters);
            (void)memcpy(own->turned, own->leaf, counters * sizeof *own->leaf);
        }
    }
}

const void *ex_canonical(ex_worker_t *worker, const void *marking)
{
    symmetry_t *own = worker->symmetry;
    if (worker->exchange != NULL) {
        return ex_instances_canonical(worker, marking);
    }
    const ex_reduction_t *reduction = own->reduction;
    for (uint32_t c = 0U; c < reduction->counters; c++) {
        own->value[c] = ex_count_of(&reduction->counter[c], marking);
    }
    (void)memcpy(own->turned, own->value, reduction->counters * sizeof *own->value);
    own->has_best = false;
    turn(own, 0U);
    uint64_t *to = own->marking;
    (void)memcpy(to, marking, pn_net.marking_size);
    (void)memset(to, 0, pn_net.packed_size);
    for (uint32_t c = 0U; c < reduction->counters; c++) {
        const ex_counter_t *counter = &reduction->counter[c];
        to[counter->word] |= (uint64_t)own->best[c] << counter->shift;
    }
    return to;
}
