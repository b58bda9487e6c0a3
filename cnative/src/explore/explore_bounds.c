/* SPDX-License-Identifier: MIT
 * explore_bounds.c - how many tokens each place holds at least and at most, and of each colour.
 *
 * Packed places are looked at in every state: their counters lie in the marking. Of neighbours that are small together
 * it is only noted which values their bits have had, and what that means is found in the end. Of a counter of one bit
 * the least and the most are the conjunction and the disjunction of all states, 64 at a time. Other places are looked
 * at once for each multi-set that they ever held (explore_intern.c has them all), however many states there are.
 */
#include "explore_run.h"
#include "state/explore_multiset.h"
#include "explore_bounds.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "pn/pn_packed.h"
#include "pn/pn_text.h"

/* One colour of a place that is not packed, as JSON. */
typedef struct colour {
    char *text;
    uint64_t hash;
    uint64_t most;
    uint64_t least;
    uint64_t seen;  /* multi-sets in which it is */
    uint64_t round; /* the last multi-set in which it was */
    uint64_t now;   /* of it there */
    uint32_t next;  /* index + 1 of another colour that is in that one too */
} colour_t;

typedef struct colours {
    colour_t *colour;
    uint32_t *entry; /* index + 1 of the colour */
    uint32_t count;
    uint32_t room; /* a power of two: of entries; half as many colours */
} colours_t;

typedef struct place_bounds {
    uint64_t least;
    uint64_t most;
    uint64_t multisets;      /* looked at */
    uint64_t arena;          /* bytes of the lists and strings of one of them, at most */
    uint32_t *counter_least; /* packed, more than one bit: by colour */
    uint32_t *counter_most;
    colours_t colours;
} place_bounds_t;

/* Packed places that are neighbours, or one of them. */
typedef struct group {
    uint32_t unit; /* 64 bits of the packed part */
    uint32_t shift;
    uint32_t bits;  /* at most SEEN_BITS; 0: that is one large place, see `first` */
    uint32_t first; /* in ex_bounds.order */
    uint32_t places;
    uint8_t *seen; /* by value of these bits */
} group_t;

enum { SEEN_BITS = 10, UNIT_BITS = 64 };

struct ex_bounds {
    uint64_t states;
    bool is_found;   /* what the threads have seen is put together, and nobody sees more */
    bool is_known;   /* and it is all of it */
    uint32_t *order; /* packed places, by their first bit */
    group_t *group;
    uint32_t groups;
    uint64_t *all; /* conjunction of the packed parts */
    uint64_t *any; /* disjunction */
    place_bounds_t *place;
};

static size_t packed_words(void)
{
    return (pn_net.packed_size + sizeof(uint64_t) - 1U) / sizeof(uint64_t);
}

static uint32_t bits_in(const pn_place_t *place)
{
    return place->multiset->colours * place->multiset->width;
}

static int by_bit(const void *a, const void *b)
{
    const pn_place_t *const first = &pn_net.place[*(const uint32_t *)a];
    const pn_place_t *const second = &pn_net.place[*(const uint32_t *)b];
    return (first->multiset->bit > second->multiset->bit) - (first->multiset->bit < second->multiset->bit);
}

/* Groups of neighbours, as many in one as possible. */
static bool make_groups(ex_bounds_t *bounds)
{
    uint32_t count = 0U;
    bounds->order = calloc((size_t)pn_net.place_count + 1U, sizeof *bounds->order);
    bounds->group = calloc((size_t)pn_net.place_count + 1U, sizeof *bounds->group);
    if ((bounds->order == NULL) || (bounds->group == NULL)) {
        return false;
    }
    for (uint32_t p = 0U; p < pn_net.place_count; p++) {
        if (pn_net.place[p].multiset->is_packed) {
            bounds->order[count++] = p;
        }
    }
    qsort(bounds->order, count, sizeof *bounds->order, by_bit);
    for (uint32_t k = 0U; k < count; k++) {
        const pn_place_t *const place = &pn_net.place[bounds->order[k]];
        const uint32_t unit = place->multiset->bit / (uint32_t)UNIT_BITS;
        const uint32_t end = (place->multiset->bit % (uint32_t)UNIT_BITS) + bits_in(place);
        const bool is_small = bits_in(place) <= (uint32_t)SEEN_BITS; /* then it lies in one unit */
        group_t *const last = &bounds->group[(bounds->groups > 0U) ? (bounds->groups - 1U) : 0U];
        if (is_small && (bounds->groups > 0U) && (last->bits > 0U) && (last->unit == unit)
            && ((end - last->shift) <= (uint32_t)SEEN_BITS)) {
            last->bits = end - last->shift;
            last->places++;
            continue;
        }
        bounds->group[bounds->groups] = (group_t){ .unit = unit,
                                                   .shift = place->multiset->bit % (uint32_t)UNIT_BITS,
                                                   .bits = is_small ? bits_in(place) : 0U,
                                                   .first = k,
                                                   .places = 1U };
        bounds->groups++;
    }
    for (uint32_t g = 0U; g < bounds->groups; g++) {
        bounds->group[g].seen = calloc((size_t)1U << bounds->group[g].bits, sizeof *bounds->group[g].seen);
        if (bounds->group[g].seen == NULL) {
            return false;
        }
    }
    return true;
}

bool ex_bounds_make(ex_worker_t *worker)
{
    ex_bounds_t *const bounds = calloc(1U, sizeof *bounds);
    worker->bounds = bounds;
    if (bounds == NULL) {
        return false;
    }
    bounds->all = calloc(packed_words() + 1U, sizeof *bounds->all);
    bounds->any = calloc(packed_words() + 1U, sizeof *bounds->any);
    bounds->place = calloc((size_t)pn_net.place_count + 1U, sizeof *bounds->place);
    if ((bounds->all == NULL) || (bounds->any == NULL) || (bounds->place == NULL)) {
        return false;
    }
    (void)memset(bounds->all, 0xff, packed_words() * sizeof *bounds->all);
    for (uint32_t p = 0U; p < pn_net.place_count; p++) {
        const pn_place_t *const place = &pn_net.place[p];
        place_bounds_t *const own = &bounds->place[p];
        own->least = UINT64_MAX;
        if (place->multiset->is_packed && (place->multiset->width > 1U)) {
            own->counter_least = calloc(place->multiset->colours, sizeof *own->counter_least);
            own->counter_most = calloc(place->multiset->colours, sizeof *own->counter_most);
            if ((own->counter_least == NULL) || (own->counter_most == NULL)) {
                return false;
            }
            (void)memset(own->counter_least, 0xff, place->multiset->colours * sizeof *own->counter_least);
        }
    }
    return make_groups(bounds);
}

/* --- packed places ------------------------------------------------------------------------------------------------ */

/* The tokens of a place with counters of one bit: those of a large place begin with a unit, those of a small one lie in
 * one. */
static uint32_t count_bits(const uint64_t *word, uint32_t bit, uint32_t colours)
{
    const uint64_t *unit = &word[bit / (uint32_t)UNIT_BITS];
    uint32_t total = 0U;
    uint32_t left = colours;
    for (; left >= (uint32_t)UNIT_BITS; left -= (uint32_t)UNIT_BITS) {
        total += (uint32_t)__builtin_popcountll(*unit);
        unit = &unit[1];
    }
    if (left > 0U) {
        const uint64_t mask = ((uint64_t)1U << left) - 1U;
        total += (uint32_t)__builtin_popcountll((*unit >> (bit % (uint32_t)UNIT_BITS)) & mask);
    }
    return total;
}

static uint64_t see_counters(place_bounds_t *own, const pn_place_t *place, const uint64_t *word)
{
    uint64_t total = 0U;
    for (uint32_t i = 0U; i < place->multiset->colours; i++) {
        const uint32_t count = pn_counter(word, place->multiset->bit, place->multiset->width, i);
        total += count;
        own->counter_least[i] = (count < own->counter_least[i]) ? count : own->counter_least[i];
        own->counter_most[i] = (count > own->counter_most[i]) ? count : own->counter_most[i];
    }
    return total;
}

static void see_place(ex_bounds_t *bounds, uint32_t p, const uint64_t *word)
{
    const pn_place_t *const place = &pn_net.place[p];
    place_bounds_t *const own = &bounds->place[p];
    const uint64_t total = (place->multiset->width == 1U)
                               ? count_bits(word, place->multiset->bit, place->multiset->colours)
                               : see_counters(own, place, word);
    own->least = (total < own->least) ? total : own->least;
    own->most = (total > own->most) ? total : own->most;
}

void ex_bounds_see(ex_worker_t *worker)
{
    ex_bounds_t *const bounds = worker->bounds;
    const uint64_t *const word = worker->marking;
    const size_t words = packed_words();
    bounds->states += 1U;
    for (size_t i = 0U; i < words; i++) {
        bounds->all[i] &= word[i];
        bounds->any[i] |= word[i];
    }
    for (uint32_t g = 0U; g < bounds->groups; g++) {
        const group_t *const group = &bounds->group[g];
        if (group->bits > 0U) {
            group->seen[(word[group->unit] >> group->shift) & (((uint64_t)1U << group->bits) - 1U)] = 1U;
        } else {
            see_place(bounds, bounds->order[group->first], word);
        }
    }
}

/* What the values that small places have had mean. False: no memory. */
static bool see_groups(ex_bounds_t *bounds)
{
    uint64_t *const word = calloc(packed_words() + 1U, sizeof *word);
    for (uint32_t g = 0U; (word != NULL) && (g < bounds->groups); g++) {
        const group_t *const group = &bounds->group[g];
        for (uint64_t value = 0U; (group->bits > 0U) && ((value >> group->bits) == 0U); value++) {
            word[group->unit] = value << group->shift;
            for (uint32_t k = 0U; (group->seen[value] != 0U) && (k < group->places); k++) {
                see_place(bounds, bounds->order[group->first + k], word);
            }
        }
        word[group->unit] = 0U;
    }
    free(word);
    return word != NULL;
}

/* Adds what another thread has seen. */
static void merge(ex_bounds_t *bounds, const ex_bounds_t *other)
{
    bounds->states += other->states;
    for (size_t i = 0U; i < packed_words(); i++) {
        bounds->all[i] &= other->all[i];
        bounds->any[i] |= other->any[i];
    }
    for (uint32_t p = 0U; p < pn_net.place_count; p++) {
        const pn_place_t *const place = &pn_net.place[p];
        place_bounds_t *const own = &bounds->place[p];
        const place_bounds_t *const theirs = &other->place[p];
        own->least = (theirs->least < own->least) ? theirs->least : own->least;
        own->most = (theirs->most > own->most) ? theirs->most : own->most;
        for (uint32_t i = 0U; (own->counter_least != NULL) && (i < place->multiset->colours); i++) {
            own->counter_least[i] =
                (theirs->counter_least[i] < own->counter_least[i]) ? theirs->counter_least[i] : own->counter_least[i];
            own->counter_most[i] =
                (theirs->counter_most[i] > own->counter_most[i]) ? theirs->counter_most[i] : own->counter_most[i];
        }
    }
}

/* --- other places ------------------------------------------------------------------------------------------------- */

static uint64_t text_hash(const char *text, size_t length)
{
    uint64_t hash = 1469598103934665603U; /* FNV-1a */
    for (size_t i = 0U; i < length; i++) {
        hash = (hash ^ (unsigned char)text[i]) * 1099511628211U;
    }
    return hash;
}

static bool enlarge(colours_t *c)
{
    const uint32_t room = (c->room == 0U) ? 16U : (c->room * 2U);
    uint32_t *const entry = calloc(room, sizeof *entry);
    colour_t *const colour = realloc(c->colour, (size_t)(room / 2U) * sizeof *colour);
    c->colour = (colour != NULL) ? colour : c->colour;
    if ((entry == NULL) || (colour == NULL)) {
        free(entry);
        return false;
    }
    for (uint32_t i = 0U; i < c->count; i++) {
        uint32_t at = (uint32_t)colour[i].hash & (room - 1U);
        while (entry[at] != 0U) {
            at = (at + 1U) & (room - 1U);
        }
        entry[at] = i + 1U;
    }
    free(c->entry);
    c->entry = entry;
    c->room = room;
    return true;
}

/* The colour with that text; a new one if there is none. NULL: no memory. */
static colour_t *find_colour(colours_t *c, const char *text, size_t length)
{
    const uint64_t hash = text_hash(text, length);
    if ((c->count >= (c->room / 2U)) && !enlarge(c)) {
        return NULL;
    }
    uint32_t at = (uint32_t)hash & (c->room - 1U);
    for (; c->entry[at] != 0U; at = (at + 1U) & (c->room - 1U)) {
        colour_t *const found = &c->colour[c->entry[at] - 1U];
        if ((found->hash == hash) && (strncmp(found->text, text, length) == 0) && (found->text[length] == '\0')) {
            return found;
        }
    }
    char *const copy = malloc(length + 1U);
    if (copy == NULL) {
        return NULL;
    }
    (void)memcpy(copy, text, length);
    copy[length] = '\0';
    colour_t *const fresh = &c->colour[c->count];
    *fresh = (colour_t){ .text = copy, .hash = hash, .least = UINT64_MAX };
    c->count += 1U;
    c->entry[at] = c->count;
    return fresh;
}

/* The end of a JSON value: the comma or bracket behind it. */
static const char *value_end(const char *text)
{
    uint32_t depth = 0U;
    bool is_string = false;
    for (; *text != '\0'; text++) {
        if (is_string) {
            if ((*text == '\\') && (text[1] != '\0')) {
                text += 1; /* a quote may be what it stands for */
            } else {
                is_string = (*text != '"');
            }
        } else if (*text == '"') {
            is_string = true;
        } else if ((*text == '[') || (*text == '{')) {
            depth += 1U;
        } else if ((*text == ']') || (*text == '}')) {
            if (depth == 0U) {
                return text;
            }
            depth -= 1U;
        } else if ((*text == ',') && (depth == 0U)) {
            return text;
        }
    }
    return text;
}

/* One multi-set of the place as JSON: [[count, value], ...] or [[count, value, stamp], ...]. */
static bool see_multiset(place_bounds_t *own, const char *text)
{
    uint64_t total = 0U;
    uint32_t first = 0U; /* index + 1 of a colour that is in it */
    own->multisets += 1U;
    const char *at = &text[1];
    while (*at == '[') {
        char *value = NULL;
        const uint64_t count = strtoull(&at[1], &value, 10);
        value += 2; /* comma, blank */
        const char *const end = value_end(value);
        colour_t *const colour = find_colour(&own->colours, value, (size_t)(end - value));
        if (colour == NULL) {
            return false;
        }
        if (colour->round != own->multisets) {
            /* In the multi-sets before this one it was not seen, or has been counted. */
            colour->round = own->multisets;
            colour->now = 0U;
            colour->seen += 1U;
            colour->next = first;
            first = (uint32_t)(colour - own->colours.colour) + 1U;
        }
        colour->now += count;
        total += count;
        at = value_end(end + ((*end == ',') ? 1 : 0)) + 1;
        at += (*at == ',') ? 2 : 0;
    }
    while (first != 0U) {
        colour_t *const colour = &own->colours.colour[first - 1U];
        colour->most = (colour->now > colour->most) ? colour->now : colour->most;
        colour->least = (colour->now < colour->least) ? colour->now : colour->least;
        first = colour->next;
    }
    own->least = (total < own->least) ? total : own->least;
    own->most = (total > own->most) ? total : own->most;
    return true;
}

#define LOOK 1024U /* multi-sets between two looks at the clock */

bool ex_bounds_see_number(ex_worker_t *worker, uint64_t number, char *buffer)
{
    ex_bounds_t *const bounds = worker->bounds;
    const ex_bytes_entry_t entry = ex_interned(worker->run)->of[number];
    pn_text_t text;
    if (entry.place >= pn_net.place_count) { /* a hole, or a time */
        return true;
    }
    const pn_place_t *const place = &pn_net.place[entry.place];
    const size_t mark = pn_arena_mark(worker->cx.arena);
    pn_text_init(&text, buffer, EX_TEXT_SIZE);
    size_t length = 0U;
    const unsigned char *byte = ex_multiset_bytes(worker, (uint32_t)number, &length);
    const bool is_fine =
        (byte != NULL) && (pn_multiset_decode(&worker->cx, place->multiset, worker->marking, byte, length) != SIZE_MAX);
    pn_multiset_json(place->multiset, worker->marking, &text);
    place_bounds_t *const own = &bounds->place[entry.place];
    const uint64_t bytes = pn_arena_mark(worker->cx.arena) - mark;
    own->arena = (bytes > own->arena) ? bytes : own->arena;
    pn_arena_release(worker->cx.arena, mark);
    return is_fine && !text.truncated && see_multiset(own, buffer);
}

/* All multi-sets that the places which are not packed ever held. */
static bool see_interned(ex_run_t *run)
{
    const ex_bytes_t *const all = ex_interned(run);
    char *const buffer = malloc(EX_TEXT_SIZE);
    bool is_fine = (buffer != NULL);
    const uint64_t count = (all != NULL) ? atomic_load(&all->index.count) : 0U;
    ex_unload(&run->worker[0]); /* they are decoded into its marking */
    for (uint64_t i = 0U; is_fine && (i < count); i++) {
        is_fine = (((i % LOOK) != (LOOK - 1U)) || !ex_is_late(run)) && ex_bounds_see_number(&run->worker[0], i, buffer);
    }
    free(buffer);
    return is_fine;
}

/* --- the report --------------------------------------------------------------------------------------------------- */

/* A list of which no more than a number of items is printed. */
typedef struct list {
    FILE *out;
    uint64_t most;
    uint64_t items; /* that belong to it */
} list_t;

static bool list_takes(const list_t *list)
{
    return list->items < list->most;
}

static void list_item(list_t *list, uint64_t count, const char *colour)
{
    if (list_takes(list)) {
        (void)fprintf(list->out, "%s[%" PRIu64 ", %s]", (list->items == 0U) ? "" : ", ", count, colour);
    }
    list->items += 1U;
}

/* Shorter ones first, then by their texts: which ones are printed must not depend on the order in which threads came
 * upon them. */
static int by_text(const void *a, const void *b)
{
    const colour_t *const left = a;
    const colour_t *const right = b;
    const size_t length = strlen(left->text);
    const size_t other = strlen(right->text);
    return (length != other) ? ((length < other) ? -1 : 1) : strcmp(left->text, right->text);
}

static void packed_json(const ex_bounds_t *bounds, const pn_place_t *place, const place_bounds_t *own, bool is_upper,
                        list_t *list, char *buffer)
{
    for (uint32_t i = 0U; i < place->multiset->colours; i++) {
        pn_text_t text;
        pn_text_init(&text, buffer, EX_TEXT_SIZE);
        uint64_t count = 0U;
        if (place->multiset->width == 1U) {
            count = pn_counter(is_upper ? bounds->any : bounds->all, place->multiset->bit, 1U, i);
        } else {
            count = is_upper ? own->counter_most[i] : own->counter_least[i];
        }
        if (count > 0U) {
            if (list_takes(list)) {
                pn_multiset_colour_json(place->multiset, i, &text);
            }
            list_item(list, count, buffer);
        }
    }
}

static void colours_json(const place_bounds_t *own, bool is_upper, list_t *list)
{
    for (uint32_t i = 0U; i < own->colours.count; i++) {
        const colour_t *const colour = &own->colours.colour[i];
        const uint64_t least = (colour->seen == own->multisets) ? colour->least : 0U;
        const uint64_t count = is_upper ? colour->most : least;
        if (count > 0U) {
            list_item(list, count, colour->text);
        }
    }
}

/* What the supervisor's arena has to hold: bytes at the start and of the values of declarations, of one occurrence, of
 * one marking (a sum over places, so that it may be too large). */
static void arena_json(const ex_run_t *run, const ex_bounds_t *bounds, FILE *out)
{
    uint64_t firing = 0U;
    uint64_t marking = 0U;
    for (uint32_t i = 0U; i < run->options.threads; i++) {
        firing = (run->worker[i].arena_most > firing) ? run->worker[i].arena_most : firing;
    }
    for (uint32_t p = 0U; (bounds != NULL) && (p < pn_net.place_count); p++) {
        marking += bounds->place[p].arena;
    }
    const pn_arena_t *const first = run->worker[0].cx.arena;
    if (bounds != NULL) {
        (void)fprintf(out, ",\n \"arena\": {\"start\": %zu, \"firing\": %" PRIu64 ", \"marking\": %" PRIu64 "}",
                      first->start, firing, marking);
    }
}

/* How many colours of a place's multi-set bounds are printed: all of those that `--whole` names. */
static uint64_t most_printed(const ex_options_t *options, uint32_t place)
{
    return ex_is_listed(options->whole, place) ? UINT64_MAX : options->multiset_limit;
}

/* For each place, how many multi-sets it ever held; 0 for a packed one, whose colours are few. */
static void different_json(const ex_run_t *run, FILE *out)
{
    const ex_bytes_t *const all = ex_interned(run);
    uint64_t *const held = calloc((pn_net.place_count > 0U) ? pn_net.place_count : 1U, sizeof *held);
    const uint64_t count = (all != NULL) ? atomic_load(&all->index.count) : 0U;
    for (uint64_t i = 0U; (held != NULL) && (i < count); i++) {
        const uint32_t place = all->of[i].place;
        if (place < pn_net.place_count) { /* no hole, and no time */
            held[place] += 1U;
        }
    }
    (void)fprintf(out, ",\n \"different\": [");
    for (uint32_t p = 0U; (held != NULL) && (p < pn_net.place_count); p++) {
        (void)fprintf(out, "%s%" PRIu64, (p > 0U) ? ", " : "", held[p]);
    }
    (void)fprintf(out, "]");
    free(held);
}

void ex_bounds_find(ex_run_t *run)
{
    ex_bounds_t *const bounds = run->worker[0].bounds;
    if ((bounds == NULL) || bounds->is_found) {
        return;
    }
    bool is_seen = ex_see_rest(run) && see_groups(bounds);
    for (uint32_t i = 1U; i < run->options.threads; i++) {
        if (run->worker[i].bounds != NULL) {
            is_seen = is_seen && see_groups(run->worker[i].bounds);
            merge(bounds, run->worker[i].bounds);
        }
    }
    bounds->is_found = true;
    bounds->is_known = is_seen && (bounds->states > 0U) && see_interned(run);
}

bool ex_bounds_are_found(const ex_run_t *run)
{
    const ex_bounds_t *const bounds = run->worker[0].bounds;
    return (bounds == NULL) || bounds->is_found;
}

void ex_bounds_json(ex_run_t *run, FILE *out)
{
    ex_bounds_find(run);
    ex_bounds_t *const bounds = run->worker[0].bounds;
    char *const buffer = malloc(EX_TEXT_SIZE);
    const bool is_known = (buffer != NULL) && (bounds != NULL) && bounds->is_known;
    (void)fprintf(out, "\"bounds\": %s", is_known ? "[" : "null");
    for (uint32_t p = 0U; is_known && (p < pn_net.place_count); p++) {
        const pn_place_t *const place = &pn_net.place[p];
        const place_bounds_t *const own = &bounds->place[p];
        const uint64_t most = most_printed(&run->options, p);
        (void)fprintf(out, "%s{\"lower\": %" PRIu64 ", \"upper\": %" PRIu64, (p > 0U) ? ", " : "", own->least,
                      own->most);
        for (int is_upper = 0; is_upper <= 1; is_upper++) {
            const char *const which = (is_upper == 1) ? "upper" : "lower";
            if (!place->multiset->is_packed && (own->colours.count > most)) {
                qsort(own->colours.colour, own->colours.count, sizeof *own->colours.colour,
                      by_text); /* found by place from here on */
            }
            list_t list = { .out = out, .most = most };
            (void)fprintf(out, ", \"%s_multiset\": [", which);
            if (place->multiset->is_packed) {
                packed_json(bounds, place, own, is_upper == 1, &list, buffer);
            } else {
                colours_json(own, is_upper == 1, &list);
            }
            (void)fprintf(out, "], \"%s_colours\": %" PRIu64, which, list.items);
        }
        (void)fprintf(out, "}");
    }
    (void)fprintf(out, "%s", is_known ? "]" : "");
    free(buffer);
    arena_json(run, is_known ? bounds : NULL, out);
    different_json(run, out);
}
