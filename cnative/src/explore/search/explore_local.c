/* SPDX-License-Identifier: MIT
 * explore_local.c - what transitions do, remembered by the places that they look at.
 *
 * What a transition can do depends on the places that it reads (and on the time) alone, and it changes few places.
 * Markings agree in most places with many others, so the same is worked out again and again: multi-sets decoded,
 * bindings searched, values compared, multi-sets encoded and numbered. Here it is worked out once for each combination
 * of what these places hold, and noted as numbers:
 *
 *     transition, words that it reads  ->  for each successor: how many bindings lead to it, and its words that are
 *                                          different
 *
 * Of a place in which a transition only puts tokens the note says which, not what becomes of the place: so what the
 * place holds does not matter. A second table knows sums: multi-set, what is added -> multi-set.
 *
 * Each thread has notes of its own, of bounded size: when there is no room left they are forgotten. A transition whose
 * notes are hardly ever found again is left alone for a while.
 */
#define _POSIX_C_SOURCE 200809L

#include "explore_local.h"
#include "explore_successors.h"
#include "../state/explore_multiset.h"

#include <string.h>

#include "pn/pn_arena.h"

enum {
    FIRST_ENTRIES = 1 << 12,
    MOST_ENTRIES = 1 << 18,
    MOST_WORDS = 1 << 22, /* of notes: 16 MiB */
    PAGE_WORDS = 1 << 16, /* counted at a time */
    MOST_NOTE = 1 << 14,  /* words of one note */
    MOST_COMPARED = 64,   /* successors of a note with which a further one is compared */
    SUMS = 1 << 15,
    TRIALS = 1024,       /* after so many it is seen whether notes pay */
    ALONE = 1 << 16,     /* how often a transition is passed over when they do not */
    SHARE_OF_MEMORY = 16 /* most of it for all notes */
};

typedef struct sum {
    uint64_t parts; /* the multi-set, and what is added; 0: none, since nothing is not added */
    uint32_t sum;
} sum_t;

typedef enum word_kind {
    WORD_BITS,  /* of the packed part: those of `mask` */
    WORD_PLACE, /* the number of what a place holds */
    WORD_ADDED  /* the number of what comes to it; EX_NO_NUMBER: nothing */
} word_kind_t;

typedef struct word {
    uint32_t cell;
    uint32_t mask;
    word_kind_t kind;
    uint32_t place; /* unless it is WORD_BITS */
} word_t;

/* How the notes of a transition look. */
typedef struct form {
    word_t *read;
    uint32_t reads;
    word_t *changed;
    uint32_t changes;
    bool is_possible;
    uint32_t trials;
    uint32_t hits;
    uint32_t alone; /* for so long it is passed over */
} form_t;

struct ex_local {
    ex_worker_t *worker;
    form_t *form;    /* by transition */
    uint64_t *entry; /* upper half: of the hash; lower half: where the note begins + 1, 0: free */
    uint32_t entries;
    uint32_t used;
    uint32_t *word; /* notes: transition, what was read, number of successors; of each: times, what has changed */
    uint32_t words;
    uint32_t counted; /* of the reservation */
    uint32_t most;
    uint64_t *hash; /* by transition, of what it reads: see ex_local_ahead */
    sum_t *sum;
    ex_change_t *change; /* of one successor */
    /* The note that is being written, at `words`. */
    uint32_t end;
    uint32_t found;
    bool is_too_long;
};

/* --- forms -------------------------------------------------------------------------------------------------------- */

/* A word of the packed part, or more bits of one that is there. */
static void add_bits(word_t *word, uint32_t *count, uint32_t cell, uint32_t mask)
{
    for (uint32_t i = 0U; i < *count; i++) {
        if (word[i].cell == cell) {
            word[i].mask |= mask;
            return;
        }
    }
    word[*count] = (word_t){ .cell = cell, .mask = mask, .kind = WORD_BITS };
    *count += 1U;
}

/* The words of a packed place. `follows`: if it follows from others, those of the others, too. */
static void add_packed(const ex_codec_t *codec, word_t *word, uint32_t *count, uint32_t p, bool follows)
{
    const pn_place_t *place = &pn_net.place[p];
    for (uint32_t i = 0U; follows && (i < place->share_count); i++) {
        add_packed(codec, word, count, place->share[i].place, follows);
    }
    const uint32_t end = place->multiset->bit + (place->multiset->colours * place->multiset->width);
    for (uint32_t w = 0U; w < codec->packed_words; w++) {
        const uint32_t from = codec->slice_bit[w];
        const uint32_t to = from + codec->slice_width[w];
        const uint32_t first = (place->multiset->bit > from) ? place->multiset->bit : from;
        const uint32_t last = (end < to) ? end : to;
        if (first < last) {
            add_bits(word, count, w, (uint32_t)((((uint64_t)1U << (last - first)) - 1U) << (first - from)));
        }
    }
}

static bool reads(const pn_transition_t *transition, uint32_t p)
{
    bool is_read = false;
    for (uint32_t i = 0U; !is_read && (i < transition->read_count); i++) {
        is_read = transition->read[i] == p;
    }
    return is_read;
}

/* The words that decide about a transition; their number. */
static uint32_t list_reads(const ex_codec_t *codec, const pn_transition_t *transition, word_t *word)
{
    uint32_t count = 0U;
    for (uint32_t i = 0U; i < transition->read_count; i++) {
        const uint32_t p = transition->read[i];
        if (pn_net.place[p].multiset->is_packed) {
            add_packed(codec, word, &count, p, true);
        } else {
            word[count++] = (word_t){ .cell = codec->word_of[p], .mask = UINT32_MAX, .kind = WORD_PLACE, .place = p };
        }
    }
    for (uint32_t i = 0U; i < transition->touched_count; i++) {
        if (pn_net.place[transition->touched[i]].multiset->is_packed) {
            add_packed(codec, word, &count, transition->touched[i],
                       false); /* what becomes of counters depends on them */
        }
    }
    if (codec->time_word != UINT32_MAX) {
        word[count++] = (word_t){ .cell = codec->time_word, .mask = UINT32_MAX, .kind = WORD_BITS };
    }
    return count;
}

/* The words that it may change; their number. */
static uint32_t list_changes(const ex_codec_t *codec, const pn_transition_t *transition, word_t *word)
{
    uint32_t count = 0U;
    for (uint32_t i = 0U; i < transition->touched_count; i++) {
        const uint32_t p = transition->touched[i];
        if (pn_net.place[p].multiset->is_packed) {
            add_packed(codec, word, &count, p, false);
        } else {
            const word_kind_t kind = reads(transition, p) ? WORD_PLACE : WORD_ADDED;
            word[count++] = (word_t){ .cell = codec->word_of[p], .kind = kind, .place = p };
        }
    }
    return count;
}

/* Those of all transitions, one behind the other in `pool`; NULL: they are only counted, with `room` for those of one.
 */
static uint64_t lay_forms(const ex_codec_t *codec, form_t *form, word_t *pool, word_t *room)
{
    uint64_t used = 0U;
    for (uint32_t t = 0U; t < pn_net.transition_count; t++) {
        const pn_transition_t *transition = &pn_net.transition[t];
        form[t].is_possible = !transition->looks && (transition->read != NULL) && (transition->successors != NULL);
        if (form[t].is_possible) {
            form[t].read = (pool != NULL) ? &pool[used] : room;
            form[t].reads = list_reads(codec, transition, form[t].read);
            used += form[t].reads;
            form[t].changed = (pool != NULL) ? &pool[used] : room;
            form[t].changes = list_changes(codec, transition, form[t].changed);
            used += form[t].changes;
        }
    }
    return used;
}

static form_t *make_forms(ex_run_t *run)
{
    const ex_codec_t *codec = run->codec;
    form_t *form = ex_table(&run->memory, pn_net.transition_count, sizeof *form);
    word_t *room = ex_table(&run->memory, codec->words, sizeof *room);
    word_t *pool = NULL;
    if ((form != NULL) && (room != NULL)) {
        pool = ex_table(&run->memory, lay_forms(codec, form, NULL, room), sizeof *pool);
    }
    if (pool != NULL) {
        (void)lay_forms(codec, form, pool, NULL);
    }
    ex_free_table(&run->memory, room, codec->words, sizeof *room);
    return (pool != NULL) ? form : NULL;
}

bool ex_local_make(ex_worker_t *worker)
{
    ex_run_t *run = worker->run;
    const bool is_reduced = (run->reduction != NULL) || run->options.is_time_reduced;
    const uint64_t most = run->options.memory / ((uint64_t)SHARE_OF_MEMORY * run->options.threads * sizeof(uint32_t));
    if (!run->options.has_notes || is_reduced || (pn_net.multiset_count == 0U) || run->codec->is_whole
        || (pn_net.root_count > 0U) || (most < (uint64_t)PAGE_WORDS)) {
        return true;
    }
    ex_local_t *own = ex_alloc(&run->memory, sizeof *own);
    if (own == NULL) {
        return false;
    }
    own->worker = worker;
    own->form = make_forms(run);
    own->most = (most < (uint64_t)MOST_WORDS) ? (uint32_t)most : (uint32_t)MOST_WORDS;
    own->entries = (uint32_t)FIRST_ENTRIES;
    own->entry = ex_alloc(&run->memory, own->entries * sizeof *own->entry);
    own->word = ex_reserve(own->most * sizeof *own->word);
    own->sum = ex_alloc(&run->memory, (uint64_t)SUMS * sizeof *own->sum);
    own->change = ex_table(&run->memory, run->codec->words, sizeof *own->change);
    own->hash = ex_table(&run->memory, pn_net.transition_count, sizeof *own->hash);
    if ((own->form == NULL) || (own->entry == NULL) || (own->word == NULL) || (own->sum == NULL)
        || (own->change == NULL) || (own->hash == NULL)) {
        return false;
    }
    worker->local = own;
    return ex_wakes_make(worker);
}

/* --- notes -------------------------------------------------------------------------------------------------------- */

static uint64_t mixed(uint64_t hash, uint64_t value)
{
    const ex_wide_t product = (ex_wide_t)(hash ^ value) * 0x9e3779b97f4a7c15U;
    return (uint64_t)product ^ (uint64_t)(product >> 64U);
}

static uint64_t hash_of(const form_t *form, uint32_t t, const uint32_t *cell)
{
    uint64_t hash = 0xe7037ed1a0b428dbU + t;
    for (uint32_t i = 0U; i < form->reads; i++) {
        hash = mixed(hash, ((uint64_t)i << 32U) | (cell[form->read[i].cell] & form->read[i].mask));
    }
    return hash;
}

/* Where it is in the table, or could be. */
static uint32_t home(const ex_local_t *own, uint64_t entry)
{
    return (uint32_t)(((entry >> 32U) * own->entries) >> 32U);
}

static bool is_note(const ex_local_t *own, const uint32_t *note, uint32_t t, const uint32_t *cell)
{
    const form_t *form = &own->form[t];
    uint32_t difference = note[0] ^ t;
    for (uint32_t i = 0U; i < form->reads; i++) {
        difference |= note[1U + i] ^ (cell[form->read[i].cell] & form->read[i].mask);
    }
    return difference == 0U;
}

static const uint32_t *find_note(const ex_local_t *own, uint64_t hash, uint32_t t, const uint32_t *cell)
{
    for (uint32_t at = home(own, hash); own->entry[at] != 0U; at = (at + 1U) & (own->entries - 1U)) {
        if ((own->entry[at] >> 32U) == (hash >> 32U)) {
            const uint32_t *note = &own->word[(uint32_t)own->entry[at] - 1U];
            if (is_note(own, note, t, cell)) {
                return note;
            }
        }
    }
    return NULL;
}

static void put_entry(ex_local_t *own, uint64_t entry)
{
    uint32_t at = home(own, entry);
    while (own->entry[at] != 0U) {
        at = (at + 1U) & (own->entries - 1U);
    }
    own->entry[at] = entry;
}

static void forget(ex_local_t *own)
{
    (void)memset(own->entry, 0, own->entries * sizeof *own->entry);
    own->used = 0U;
    own->words = 0U;
}

/* Room for one more entry. */
static void grow(ex_local_t *own)
{
    if ((2U * (own->used + 1U)) <= own->entries) {
        return;
    }
    ex_run_t *run = own->worker->run;
    const uint32_t before = own->entries;
    uint64_t *old = own->entry;
    uint64_t *larger =
        (before < (uint32_t)MOST_ENTRIES) ? ex_alloc(&run->memory, 2U * (uint64_t)before * sizeof *larger) : NULL;
    if (larger == NULL) {
        forget(own);
        return;
    }
    own->entry = larger;
    own->entries = 2U * before;
    for (uint32_t i = 0U; i < before; i++) {
        if (old[i] != 0U) {
            put_entry(own, old[i]);
        }
    }
    ex_free(&run->memory, old, before * sizeof *old);
}

/* Room for a note; false: there is no memory at all. */
static bool reserve(ex_local_t *own)
{
    if ((own->words + (uint32_t)MOST_NOTE) > own->most) {
        forget(own);
    }
    while ((own->words + (uint32_t)MOST_NOTE) > own->counted) {
        if (((own->counted + (uint32_t)PAGE_WORDS) > own->most)
            || !ex_count(&own->worker->run->memory, (uint64_t)PAGE_WORDS * sizeof *own->word)) {
            if (own->words == 0U) {
                return false;
            }
            own->most = own->counted;
            forget(own);
            continue;
        }
        own->counted += (uint32_t)PAGE_WORDS;
    }
    return true;
}

/* --- writing a note ----------------------------------------------------------------------------------------------- */

static bool write_change(const ex_local_t *own, const word_t *word, const void *next, uint32_t *value)
{
    ex_worker_t *worker = own->worker;
    switch (word->kind) {
    case WORD_BITS: *value = ex_packed_word(worker->run->codec, next, word->cell) & word->mask; return true;
    case WORD_PLACE: return ex_number_place(worker, word->place, word->place, next, value);
    case WORD_ADDED:
    default:
        *value = EX_NO_NUMBER;
        return (pn_multiset_total(pn_net.place[word->place].multiset, next) == 0U)
               || ex_number_place(worker, word->place, EX_ADDED + word->place, next, value);
    }
}

static bool on_next(void *user, uint32_t t, const void *binding, const void *next)
{
    ex_local_t *own = user;
    const form_t *form = &own->form[t];
    const uint32_t length = 1U + form->changes;
    uint32_t *fresh = &own->word[own->end];
    (void)binding;
    own->is_too_long = ((own->end + length) > (own->words + (uint32_t)MOST_NOTE)) || ex_is_stopping(own->worker->run);
    if (own->is_too_long) {
        return false;
    }
    fresh[0] = 1U;
    for (uint32_t i = 0U; i < form->changes; i++) {
        if (!write_change(own, &form->changed[i], next, &fresh[1U + i])) {
            return false;
        }
    }
    const uint32_t compared = (own->found < (uint32_t)MOST_COMPARED) ? own->found : (uint32_t)MOST_COMPARED;
    for (uint32_t i = 1U; i <= compared; i++) {
        uint32_t *other = fresh - ((size_t)i * length);
        if (memcmp(&other[1], &fresh[1], form->changes * sizeof *fresh) == 0) {
            other[0]++;
            return true;
        }
    }
    own->found++;
    own->end += length;
    return true;
}

/* Only what is read is there; where tokens are only put there are none, so that what is there in the end has been put.
 */
static bool prepare(ex_local_t *own, const form_t *form)
{
    ex_worker_t *worker = own->worker;
    for (uint32_t i = 0U; i < form->reads; i++) {
        const word_t *word = &form->read[i];
        if ((word->kind == WORD_PLACE) && !ex_load_place(worker, word->place, worker->scratch->cell[word->cell])) {
            return false;
        }
    }
    for (uint32_t i = 0U; i < form->changes; i++) {
        if (form->changed[i].kind == WORD_ADDED) {
            ex_clear_place(worker, form->changed[i].place);
        }
    }
    return true;
}

/* NULL: this cannot be noted. */
static const uint32_t *write_note(ex_local_t *own, uint64_t hash, uint32_t t)
{
    ex_worker_t *worker = own->worker;
    const form_t *form = &own->form[t];
    const uint32_t *cell = worker->scratch->cell;
    if (!reserve(own) || !prepare(own, form)) {
        return NULL;
    }
    grow(own);
    uint32_t *note = &own->word[own->words];
    note[0] = t;
    for (uint32_t i = 0U; i < form->reads; i++) {
        note[1U + i] = cell[form->read[i].cell] & form->read[i].mask;
    }
    own->end = own->words + 2U + form->reads;
    own->found = 0U;
    own->is_too_long = false;
    const size_t mark = ex_arena_begin(worker);
    (void)pn_net.transition[t].successors(&worker->cx, worker->marking, t, worker->scratch->next, on_next, own);
    ex_arena_end(worker, mark);
    if (worker->failed || own->is_too_long || (worker->cx.error != PN_OK)) {
        worker->cx.error = PN_OK; /* comes again where everything is as usual */
        return NULL;
    }
    note[1U + form->reads] = own->found;
    put_entry(own, ((hash >> 32U) << 32U) | (own->words + 1U));
    own->used++;
    own->words = own->end;
    return note;
}

void ex_local_ahead(ex_worker_t *worker, const uint32_t *t, uint32_t count)
{
    ex_local_t *own = worker->local;
    for (uint32_t i = 0U; i < count; i++) {
        const form_t *form = &own->form[t[i]];
        if (form->is_possible && (form->alone == 0U)) {
            own->hash[t[i]] = hash_of(form, t[i], worker->scratch->cell);
            __builtin_prefetch(&own->entry[home(own, own->hash[t[i]])]);
        }
    }
    for (uint32_t i = 0U; i < count; i++) {
        const form_t *form = &own->form[t[i]];
        if (form->is_possible && (form->alone == 0U)) {
            const uint64_t entry = own->entry[home(own, own->hash[t[i]])];
            if ((entry != 0U) && ((entry >> 32U) == (own->hash[t[i]] >> 32U))) {
                __builtin_prefetch(&own->word[(uint32_t)entry - 1U]);
            }
        }
    }
}

/* The note, found or written; NULL: there is none. */
static const uint32_t *note_of(ex_local_t *own, uint32_t t)
{
    form_t *form = &own->form[t];
    if (!form->is_possible || (form->alone > 0U)) {
        form->alone -= (form->alone > 0U) ? 1U : 0U;
        return NULL;
    }
    const uint32_t *cell = own->worker->scratch->cell;
    const uint64_t hash = own->hash[t];
    const uint32_t *note = find_note(own, hash, t, cell);
    form->trials++;
    if (note != NULL) {
        form->hits++;
    } else {
        note = write_note(own, hash, t);
        form->trials += (note == NULL) ? (uint32_t)(TRIALS / 8) : 0U; /* that costs twice */
    }
    if (form->trials >= (uint32_t)TRIALS) {
        form->alone = (form->hits < (form->trials / 4U)) ? (uint32_t)ALONE : 0U;
        form->trials = 0U;
        form->hits = 0U;
    }
    return note;
}

/* --- reading a note ----------------------------------------------------------------------------------------------- */

/* What a place holds when something comes to it. */
static bool add_up(ex_local_t *own, const word_t *word, uint32_t t, uint32_t added, uint32_t *value)
{
    ex_worker_t *worker = own->worker;
    const uint32_t before = worker->scratch->cell[word->cell];
    const uint64_t parts = ((uint64_t)before << 32U) | added;
    sum_t *sum = &own->sum[mixed(0xa0761d6478bd642fU, parts) % (uint64_t)SUMS];
    if (sum->parts == parts) {
        *value = sum->sum;
        return true;
    }
    if (!ex_load_place(worker, word->place, before)) {
        return false;
    }
    size_t size = 0U;
    const unsigned char *byte = ex_multiset_bytes(worker, added, &size);
    if (byte == NULL) {
        return false;
    }
    const size_t mark = pn_arena_mark(&worker->scratch->arena);
    const size_t length =
        pn_multiset_add_bytes(&worker->cx, pn_net.place[word->place].multiset, worker->marking, byte, size);
    const bool is_fine =
        (length != SIZE_MAX) && ex_number_place(worker, word->place, word->place, worker->marking, value);
    ex_clear_place(worker, word->place);
    pn_arena_release(&worker->scratch->arena, mark);
    if (worker->cx.error != PN_OK) {
        ex_fail(worker, (int64_t)t);
    }
    if (is_fine) {
        *sum = (sum_t){ .parts = parts, .sum = *value };
    }
    return is_fine;
}

/* The key of a successor. */
static bool encode(ex_local_t *own, uint32_t t, const uint32_t *changed, ex_key_t *key)
{
    const form_t *form = &own->form[t];
    const uint32_t *cell = own->worker->scratch->cell;
    for (uint32_t i = 0U; i < form->changes; i++) {
        const word_t *word = &form->changed[i];
        ex_change_t *change = &own->change[i];
        change->cell = word->cell;
        change->value = changed[i];
        if (word->kind == WORD_BITS) {
            change->value |= cell[word->cell] & ~word->mask;
        } else if (word->kind == WORD_ADDED) {
            if (changed[i] == EX_NO_NUMBER) {
                change->value = cell[word->cell];
            } else if (!add_up(own, word, t, changed[i], &change->value)) {
                return false;
            }
        } else {
            /* as it was noted */
        }
    }
    return ex_encode_changes(own->worker, own->change, form->changes, key);
}

ex_local_found_t ex_local_successors(ex_worker_t *worker, uint32_t t, ex_times_sink_t sink, void *user)
{
    ex_local_t *own = worker->local;
    const uint32_t *note = note_of(own, t);
    if (note == NULL) {
        return worker->failed ? EX_LOCAL_FAILED : EX_LOCAL_UNKNOWN;
    }
    const form_t *form = &own->form[t];
    const uint32_t length = 1U + form->changes;
    const uint32_t found = note[1U + form->reads];
    const uint32_t *successor = &note[2U + form->reads];
    for (uint32_t i = 0U; i < found; i++) {
        ex_key_t key;
        if (!encode(own, t, &successor[1], &key)) {
            return EX_LOCAL_FAILED;
        }
        if (!sink(user, t, successor[0], &key)) {
            return EX_LOCAL_STOPPED;
        }
        successor = &successor[length];
    }
    return (found > 0U) ? EX_LOCAL_SOME : EX_LOCAL_NONE;
}
