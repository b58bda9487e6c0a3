/* SPDX-License-Identifier: MIT
 * explore_layout.c - which words of the vectors become a part of the key together.
 *
 * A part needs a number for each combination of its words that occurs; so words that depend on each other belong
 * together. How many combinations there are is estimated from a sample: at the beginning of states on a way at random,
 * later of states from the store, whose keys are then made anew. Beginning with each place for itself, the two parts
 * whose union adds the fewest combinations are united, until there are four.
 */
#include "../explore_run.h"
#include "explore_successors.h"

#include <string.h>

enum {
    SAMPLES = 2048,
    FEW_SAMPLES = 64, /* where reductions make successors expensive, and states few */
    MOST_SAMPLES = 16384,
    WORK = 4 << 20, /* samples times pairs of items, about, of a second look */
    APART = 3,      /* steps from one to the next */
    LONGEST = 768,  /* steps before the way begins again */
    MOST_ITEMS = 40,
    SET_SIZE = 32768 /* a power of two, more than MOST_SAMPLES */
};

typedef struct item {
    uint32_t first; /* in `next` */
    uint32_t last;
    uint32_t words;
    double number;  /* of combinations, estimated */
    bool is_united; /* with another one: gone */
} item_t;

typedef struct layout {
    ex_run_t *run;
    uint32_t samples;
    uint32_t room;   /* for samples */
    uint64_t *value; /* of item i in sample s: value[i * room + s] */
    uint32_t *next;  /* word -> the next one of the item */
    item_t item[MOST_ITEMS];
    uint32_t items;
    uint64_t set[SET_SIZE];
    uint32_t times[SET_SIZE];
    double number[MOST_ITEMS][MOST_ITEMS]; /* of combinations of the union */
    uint64_t random;
    ex_key_t drawn;
    uint64_t seen;
} layout_t;

static uint64_t mixed(uint64_t a, uint64_t b)
{
    const ex_key_t key = { a, b };
    return ex_hash(&key) | 1U; /* never 0 */
}

/* Draws one of the successors, all equally likely. */
static bool draw(void *user, uint32_t transition, const void *binding, const ex_key_t *key)
{
    layout_t *layout = user;
    (void)transition;
    (void)binding;
    layout->seen++;
    layout->random = (layout->random * 6364136223846793005U) + 1442695040888963407U;
    if (ex_scaled(layout->random, layout->seen) == 0U) {
        layout->drawn = *key;
    }
    return true;
}

/* Takes the loaded state into the sample. */
static void note(layout_t *layout, const uint32_t *cell)
{
    for (uint32_t i = 0U; i < layout->items; i++) {
        uint64_t value = 1U;
        for (uint32_t w = layout->item[i].first; w != UINT32_MAX; w = layout->next[w]) {
            value = mixed(value, cell[w]);
        }
        layout->value[((size_t)i * layout->room) + layout->samples] = value;
    }
    layout->samples++;
}

static bool walk(layout_t *layout)
{
    ex_worker_t *worker = &layout->run->worker[0];
    ex_key_t initial;
    if (!ex_encode(worker, worker->marking, &initial)) {
        return false;
    }
    ex_key_t key = initial;
    for (uint32_t step = 0U; (layout->samples < layout->room) && !ex_is_stopping(layout->run); step++) {
        if ((step % (uint32_t)APART) == 0U) {
            if (!ex_load(worker, &key)) {
                return false;
            }
            note(layout, worker->scratch->cell);
        }
        layout->seen = 0U;
        const ex_found_t found = ex_successors(worker, &key, draw, layout);
        if (found == EX_FAILED) {
            return false;
        }
        const bool is_end = (found == EX_DEAD) || (layout->seen == 0U); /* or the reductions look at nothing here */
        key = (is_end || ((step % (uint32_t)LONGEST) == ((uint32_t)LONGEST - 1U))) ? initial : layout->drawn;
    }
    return true;
}

/* The number of combinations of two items (the same twice: of one): those in the sample, and as many more as those that
 * are in it once and twice suggest (Chao's estimate). */
static double estimate(layout_t *layout, uint32_t a, uint32_t b)
{
    const uint64_t *first = &layout->value[(size_t)a * layout->room];
    const uint64_t *second = &layout->value[(size_t)b * layout->room];
    uint32_t size = 64U;
    while (size < (2U * layout->samples)) {
        size *= 2U;
    }
    uint32_t distinct = 0U;
    uint32_t once = 0U;
    uint32_t twice = 0U;
    (void)memset(layout->set, 0, size * sizeof layout->set[0]);
    (void)memset(layout->times, 0, size * sizeof layout->times[0]);
    for (uint32_t s = 0U; s < layout->samples; s++) {
        const uint64_t turned = (second[s] << 31U) | (second[s] >> 33U);
        const uint64_t value = (a == b) ? first[s] : ((first[s] * 0x9e3779b97f4a7c15U) ^ turned);
        uint32_t at = (uint32_t)(value >> 40U) & (size - 1U);
        while ((layout->times[at] != 0U) && (layout->set[at] != value)) {
            at = (at + 1U) & (size - 1U);
        }
        layout->set[at] = value;
        layout->times[at]++;
        distinct += (layout->times[at] == 1U) ? 1U : 0U;
        once += (layout->times[at] == 1U) ? 1U : 0U;
        once -= (layout->times[at] == 2U) ? 1U : 0U;
        twice += (layout->times[at] == 2U) ? 1U : 0U;
        twice -= (layout->times[at] == 3U) ? 1U : 0U;
    }
    return (double)distinct + (((double)once * ((double)once - 1.0)) / (2.0 * ((double)twice + 1.0)));
}

/* Items: the words of a place, or more of them where there are too many. */
static void make_items(layout_t *layout)
{
    const ex_codec_t *codec = layout->run->codec;
    uint32_t places = 0U;
    for (uint32_t w = 0U; w < codec->words; w++) {
        places += ((w < codec->packed_words) && codec->is_joined[w]) ? 0U : 1U;
    }
    const uint32_t each = (places + (uint32_t)MOST_ITEMS - 1U) / (uint32_t)MOST_ITEMS;
    uint32_t place = 0U;
    for (uint32_t w = 0U; w < codec->words; w++) {
        const bool is_joined = (w < codec->packed_words) && codec->is_joined[w];
        layout->next[w] = UINT32_MAX;
        if (!is_joined && ((place++ % each) == 0U)) {
            layout->item[layout->items++] = (item_t){ .first = w, .last = w, .words = 1U };
            continue;
        }
        item_t *item = &layout->item[layout->items - 1U];
        layout->next[item->last] = w;
        item->last = w;
        item->words++;
    }
}

static void unite(layout_t *layout, uint32_t a, uint32_t b)
{
    item_t *item = &layout->item[a];
    item_t *other = &layout->item[b];
    uint64_t *first = &layout->value[(size_t)a * layout->room];
    const uint64_t *second = &layout->value[(size_t)b * layout->room];
    for (uint32_t s = 0U; s < layout->samples; s++) {
        first[s] = mixed(first[s], second[s]);
    }
    layout->next[item->last] = other->first;
    item->last = other->last;
    item->words += other->words;
    item->number = layout->number[a][b];
    other->is_united = true;
}

/* Unites items until they fit into a key. */
static void unite_all(layout_t *layout)
{
    const uint32_t items = layout->items;
    for (uint32_t a = 0U; a < items; a++) {
        layout->item[a].number = estimate(layout, a, a);
        for (uint32_t b = 0U; b < a; b++) {
            layout->number[b][a] = estimate(layout, b, a);
        }
    }
    for (uint32_t left = items; left > EX_KEY_WORDS; left--) {
        uint32_t best_a = 0U;
        uint32_t best_b = 0U;
        double best = 1e300;
        for (uint32_t b = 1U; b < items; b++) {
            for (uint32_t a = 0U; (a < b) && !layout->item[b].is_united; a++) {
                if (layout->item[a].is_united) {
                    continue;
                }
                const double more = layout->number[a][b] - layout->item[a].number - layout->item[b].number;
                /* Of what makes no difference, short parts: less has to be looked up. */
                const double cost = more + (0.01 * (double)(layout->item[a].words + layout->item[b].words));
                if (cost < best) {
                    best = cost;
                    best_a = a;
                    best_b = b;
                }
            }
        }
        unite(layout, best_a, best_b);
        for (uint32_t i = 0U; i < items; i++) {
            if (!layout->item[i].is_united && (i != best_a)) {
                const uint32_t low = (i < best_a) ? i : best_a;
                const uint32_t high = (i < best_a) ? best_a : i;
                layout->number[low][high] = estimate(layout, low, high);
            }
        }
    }
}

static void regroup(layout_t *layout, uint32_t *word)
{
    uint32_t end[EX_KEY_WORDS];
    uint32_t parts = 0U;
    uint32_t at = 0U;
    for (uint32_t i = 0U; i < layout->items; i++) {
        if (layout->item[i].is_united) {
            continue;
        }
        for (uint32_t w = layout->item[i].first; w != UINT32_MAX; w = layout->next[w]) {
            word[at++] = w;
        }
        end[parts++] = at;
    }
    ex_codec_group(layout->run->codec, word, end, parts);
}

/* What went wrong on the way goes wrong again when the exploration comes there. */
static void forget(ex_run_t *run)
{
    ex_worker_t *worker = &run->worker[0];
    const int why = atomic_load(&run->why);
    worker->failed = false;
    ex_unload(worker);
    worker->scratch->undone = 0U;
    worker->cx.error = PN_OK;
    if ((why == (int)EX_ERROR) || (why == (int)EX_CAPACITY)) {
        (void)memset(&run->error, 0, sizeof run->error);
        atomic_store(&run->why, (int)EX_COMPLETE);
        atomic_store(&run->is_stopping, false);
    }
}

static uint64_t value_bytes(uint32_t samples)
{
    return (uint64_t)MOST_ITEMS * samples * sizeof(uint64_t);
}

bool ex_layout(ex_run_t *run)
{
    const ex_codec_t *codec = run->codec;
    if ((codec->words <= EX_KEY_WORDS)
        || !ex_is_repeatable()) { /* else looking at some states beforehand would change something */
        return true;
    }
    const uint64_t values = value_bytes((uint32_t)SAMPLES);
    const uint64_t words = ((uint64_t)codec->words + 1U) * sizeof(uint32_t);
    layout_t *layout = ex_alloc(&run->memory, sizeof *layout);
    uint64_t *value = ex_alloc(&run->memory, values);
    uint32_t *next = ex_alloc(&run->memory, words);
    uint32_t *word = ex_alloc(&run->memory, words);
    bool is_fine = true;
    if ((layout != NULL) && (value != NULL) && (next != NULL) && (word != NULL)) {
        layout->run = run;
        layout->value = value;
        layout->next = next;
        layout->random = 1U;
        layout->room = (run->reduction != NULL) ? (uint32_t)FEW_SAMPLES : (uint32_t)SAMPLES;
        make_items(layout);
        if (layout->items > EX_KEY_WORDS) {
            (void)walk(layout);
            forget(run);
            unite_all(layout);
        }
        regroup(layout, word);
        is_fine = ex_codec_number(run);
    }
    ex_free(&run->memory, word, words);
    ex_free(&run->memory, next, words);
    ex_free(&run->memory, value, values);
    ex_free(&run->memory, layout, sizeof *layout);
    return is_fine;
}

/* --- a second look ------------------------------------------------------------------------------------------------ */

/* From keys of one kind to keys of another. */
typedef struct change {
    const ex_codec_t *old;
    ex_codec_t *new;
    uint32_t *old_cell;
    uint32_t *new_cell;
    bool has_failed; /* no memory */
} change_t;

static void replace_key(const void *user, ex_key_t *key)
{
    change_t *change = *(change_t *const *)user;
    ex_key_cells(change->old, key, change->old_cell);
    (void)memcpy(change->new_cell, change->old_cell, change->new->words * sizeof *change->new_cell);
    if (!ex_cells_key(change->new, change->new_cell, key)) {
        change->has_failed = true;
    }
}

/* States from all of the store. */
static void sample_store(layout_t *layout, uint32_t *cell)
{
    const ex_store_t *store = &layout->run->store;
    const uint64_t used = atomic_load(&store->used);
    const uint64_t step = (used / layout->room) + 1U;
    uint64_t seen = 0U;
    for (uint64_t slot = 0U; (slot < ex_store_slots(store)) && (layout->samples < layout->room); slot++) {
        ex_key_t key;
        if (ex_store_fetch(store, slot, &key) && ((seen++ % step) == 0U)) {
            ex_key_cells(layout->run->codec, &key, cell);
            note(layout, cell);
        }
    }
}

/* The store with other keys. */
static bool refill(ex_run_t *run, change_t *change)
{
    ex_store_t *store = &run->store;
    const uint64_t used = atomic_load(&store->used);
    const uint64_t bytes = (used + 1U) * sizeof(ex_key_t);
    ex_key_t *key = ex_alloc(&run->memory, bytes);
    uint64_t count = 0U;
    if (key == NULL) {
        return false;
    }
    const change_t *const shared = change;
    for (uint64_t slot = 0U; (slot < ex_store_slots(store)) && !change->has_failed; slot++) {
        if (ex_store_fetch(store, slot, &key[count])) {
            replace_key(&shared, &key[count]);
            count++;
        }
    }
    uint32_t width[EX_KEY_WORDS];
    ex_store_t new;
    ex_key_widths(run, width);
    const bool is_fine = !change->has_failed
                         && ex_store_make(&new, &run->memory, &run->team, ex_has_words(run), width, (used * 3U) / 2U);
    for (uint64_t i = 0U; is_fine && (i < count); i++) {
        (void)ex_store_insert(&new, &key[i], ex_hash(&key[i]), NULL);
    }
    ex_free(&run->memory, key, bytes);
    if (is_fine) {
        ex_store_free(store);
        ex_store_replace(store, &new);
        atomic_store(&store->used, count);
    }
    return is_fine;
}

/* Other tables of nodes and numbers, beside the old ones. */
static bool rebuild(ex_run_t *run, layout_t *layout, change_t *change, uint32_t *word,
                    void (*replace)(ex_run_t *run, ex_replace_t one, const void *layout))
{
    ex_codec_t *codec = run->codec;
    const uint64_t words = codec->words;
    ex_codec_t old = *codec;
    codec->node = ex_alloc(&run->memory, (words + 1U) * sizeof *codec->node);
    codec->parent = ex_alloc(&run->memory, 2U * (words + 1U) * sizeof *codec->parent);
    (void)memset(codec->tuples, 0, sizeof codec->tuples);
    if ((codec->node == NULL) || (codec->parent == NULL)) {
        return false;
    }
    regroup(layout, word);
    if (!ex_codec_number(run)) {
        return false;
    }
    change->old = &old;
    change->new = codec;
    if (!refill(run, change)) {
        return false;
    }
    const change_t *const shared = change;
    replace_key(&shared, &run->initial);
    replace(run, replace_key, &shared);
    for (uint32_t i = 0U; i < EX_TABLES; i++) {
        if (old.tuples[i].lane != NULL) {
            ex_tuples_free(&old.tuples[i]);
        }
    }
    return !change->has_failed;
}

bool ex_layout_again(ex_run_t *run, void (*replace)(ex_run_t *run, ex_replace_t one, const void *layout))
{
    const ex_codec_t *codec = run->codec;
    if (codec->words <= EX_KEY_WORDS) {
        return true;
    }
    const uint64_t cells = (2U * ((uint64_t)codec->words + 1U)) * sizeof(uint32_t);
    const uint64_t values = value_bytes((uint32_t)MOST_SAMPLES);
    layout_t *layout = ex_alloc(&run->memory, sizeof *layout);
    uint64_t *value = ex_alloc(&run->memory, values);
    uint32_t *cell = ex_alloc(&run->memory, 4U * cells);
    bool is_fine = true;
    if ((layout != NULL) && (value != NULL) && (cell != NULL)) {
        const uint64_t table = cells / sizeof *cell;
        change_t change = { .old_cell = cell, .new_cell = &cell[table] };
        layout->run = run;
        layout->value = value;
        layout->next = &cell[2U * table];
        make_items(layout);
        const uint32_t pairs = (layout->items * layout->items) + 1U;
        const uint32_t samples = (uint32_t)WORK / pairs;
        layout->room = (samples < (uint32_t)SAMPLES) ? (uint32_t)SAMPLES : samples;
        layout->room = (layout->room > (uint32_t)MOST_SAMPLES) ? (uint32_t)MOST_SAMPLES : layout->room;
        if (layout->items > EX_KEY_WORDS) {
            sample_store(layout, cell);
            unite_all(layout);
            (void)memset(cell, 0, 2U * cells);
            is_fine = rebuild(run, layout, &change, &cell[3U * table], replace);
        }
    }
    ex_free(&run->memory, cell, 4U * cells);
    ex_free(&run->memory, value, values);
    ex_free(&run->memory, layout, sizeof *layout);
    return is_fine;
}
