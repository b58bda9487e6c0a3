/* SPDX-License-Identifier: MIT
 * explore_core.c - the store and the tables of numbers against plain ones: `explore_core
 * store|threads|meetings|numbers|memory SEED`.
 *
 * Prints `fine`, or what is wrong.
 */
#include <pthread.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../src/explore/state/explore_intern.h"
#include "../src/explore/store/explore_store.h"

static uint64_t s_random;

static uint64_t draw(uint64_t below)
{
    s_random = (s_random * 6364136223846793005U) + 1442695040888963407U;
    return ex_scaled(s_random ^ (s_random << 29U), below);
}

static void check(bool is_fine, const char *what)
{
    if (!is_fine) {
        (void)printf("%s\n", what);
        exit(1);
    }
}

/* --- a plain set: keys of which it is remembered whether they are in it ------------------------------------------- */

enum { KEYS = 1 << 20, WORKERS = 4 };

typedef struct plain {
    ex_key_t key;
    bool is_in;
} plain_t;

static plain_t s_plain[KEYS];

/* Key number i: all different, with words of so many bits. */
static ex_key_t numbered(uint64_t i, const uint32_t width[EX_KEY_WORDS])
{
    uint32_t word[EX_KEY_WORDS];
    uint64_t rest = i;
    uint64_t mixed = i * 0x9e3779b97f4a7c15U;
    for (uint32_t k = 0U; k < EX_KEY_WORDS; k++) {
        const uint64_t mask = ((uint64_t)1U << width[k]) - 1U;
        if (rest > 0U) {
            word[k] = (uint32_t)(rest & mask);
            rest >>= width[k];
        } else {
            word[k] = (uint32_t)((mixed >> 32U) & mask);
            mixed *= 0xd6e8feb86659fd93U;
        }
    }
    /* The words that the number itself did not need depend on it: different numbers stay different. */
    return (ex_key_t){ word[0] | ((uint64_t)word[1] << 32U), word[2] | ((uint64_t)word[3] << 32U) };
}

typedef struct part {
    void (*one)(void *user, uint32_t part);
    void *user;
    uint32_t number;
} part_t;

static void *do_part(void *user)
{
    const part_t *part = user;
    part->one(part->user, part->number);
    return NULL;
}

/* What the threads of an exploration do in a pause: here each part has one of its own. */
static void together(void *self, uint32_t parts, void (*one)(void *user, uint32_t part), void *user)
{
    enum { MOST = 16 };
    pthread_t thread[MOST];
    part_t part[MOST];
    (void)self;
    check(parts <= (uint32_t)MOST, "too many parts");
    for (uint32_t i = 0U; i < parts; i++) {
        part[i] = (part_t){ .one = one, .user = user, .number = i };
        check(pthread_create(&thread[i], NULL, do_part, &part[i]) == 0, "no thread");
    }
    for (uint32_t i = 0U; i < parts; i++) {
        (void)pthread_join(thread[i], NULL);
    }
}

/* Memory of so many bytes, and threads that make large tables grow. */
typedef struct ground {
    ex_memory_t memory;
    ex_team_t team;
} ground_t;

static ground_t ground_of(uint64_t bytes)
{
    const ex_team_t team = { .threads = 1U + (uint32_t)draw(3U), .together = together };
    return (ground_t){ .memory = { .limit = bytes }, .team = team };
}

/* --- the store ---------------------------------------------------------------------------------------------------- */

static uint64_t count_slots(const ex_store_t *store)
{
    uint64_t used = 0U;
    for (uint64_t slot = 0U; slot < ex_store_slots(store); slot++) {
        ex_key_t key;
        if (ex_store_fetch(store, slot, &key)) {
            used++;
            check(ex_store_find(store, &key, ex_hash(&key)) == slot, "a key is not found in its slot");
        }
    }
    return used;
}

static const uint32_t s_word_widths[EX_KEY_WORDS] = { 32U, 31U, 0U, 0U };

/* Words of the keys of such widths, or keys of one word; half of the keys come later than the others. */
static void try_store(const uint32_t width[EX_KEY_WORDS], uint64_t keys)
{
    ex_store_t store;
    ground_t ground = ground_of((uint64_t)1U << 30U);
    check(ex_store_make(&store, &ground.memory, &ground.team, width == s_word_widths, width, 16U), "no memory");
    uint64_t inserted = 0U;
    (void)memset(s_plain, 0, sizeof s_plain);
    for (uint64_t step = 0U; step < (3U * keys); step++) {
        const uint64_t i = draw((step < keys) ? (keys / 2U) : keys);
        const ex_key_t key = numbered(i + 1U, width);
        const uint64_t hash = ex_hash(&key);
        check((ex_store_find(&store, &key, hash) != EX_NO_SLOT) == s_plain[i].is_in, "found, or not found, wrongly");
        uint64_t slot = EX_NO_SLOT;
        ex_insertion_t insertion = ex_store_insert(&store, &key, hash, &slot);
        for (uint32_t k = 0U; (k < 4U) && (insertion == EX_FULL); k++) {
            check(ex_store_grow(&store, width), "it does not grow");
            insertion = ex_store_insert(&store, &key, hash, &slot);
        }
        check(insertion == (s_plain[i].is_in ? EX_KNOWN : EX_NEW), "known, or new, wrongly");
        check(ex_store_find(&store, &key, hash) == slot, "not where it was put");
        inserted += (insertion == EX_NEW) ? 1U : 0U;
        s_plain[i].is_in = true;
        s_plain[i].key = key;
        atomic_store(&store.used, inserted);
        if (inserted > store.limit) {
            check(ex_store_grow(&store, width), "it does not grow");
        }
    }
    for (uint64_t i = 0U; i < keys; i++) {
        const ex_key_t *const key = &s_plain[i].key;
        ex_key_t back = { 0U, 0U };
        if (s_plain[i].is_in) {
            const uint64_t slot = ex_store_find(&store, key, ex_hash(key));
            check((slot != EX_NO_SLOT) && ex_store_fetch(&store, slot, &back), "lost");
            check((back.low == key->low) && (back.high == key->high), "another key came back");
        }
    }
    check(count_slots(&store) == inserted, "another number of slots than of keys");
    ex_store_free(&store);
    check(atomic_load(&ground.memory.used) == 0U, "memory is counted that was given back");
}

static void try_stores(void)
{
    static const uint32_t s_layouts[][EX_KEY_WORDS] = {
        { 20U, 0U, 0U, 0U }, { 32U, 0U, 0U, 0U },  { 12U, 13U, 7U, 0U },   { 32U, 24U, 14U, 0U },
        { 1U, 3U, 25U, 9U }, { 32U, 32U, 0U, 0U }, { 32U, 32U, 32U, 32U }, { 17U, 0U, 13U, 32U },
    };
    for (size_t i = 0U; i < (sizeof s_layouts / sizeof s_layouts[0]); i++) {
        try_store(s_layouts[i], (uint64_t)20000U + draw(60000U));
    }
    try_store(s_word_widths, (uint64_t)20000U + draw(60000U));
    ex_store_t store;
    ground_t ground = ground_of((uint64_t)1U << 28U);
    const uint32_t narrow[EX_KEY_WORDS] = { 4U, 4U, 0U, 0U };
    const uint32_t wide[EX_KEY_WORDS] = { 20U, 9U, 0U, 0U };
    check(ex_store_make(&store, &ground.memory, &ground.team, false, narrow, 64U), "no memory");
    uint64_t inserted = 0U;
    bool is_wide = false;
    for (uint64_t i = 0U; i < 50000U; i++) {
        const ex_key_t key = { (i * 7U) | ((i & 511U) << 32U), 0U };
        ex_insertion_t insertion = ex_store_insert(&store, &key, ex_hash(&key), NULL);
        check(is_wide || ((i * 7U) < 16U) || (insertion == EX_FULL), "a key that does not fit is taken");
        while (insertion == EX_FULL) {
            check(ex_store_grow(&store, wide), "it does not become wider");
            is_wide = true;
            insertion = ex_store_insert(&store, &key, ex_hash(&key), NULL);
        }
        check(insertion == EX_NEW, "not new");
        inserted++;
        atomic_store(&store.used, inserted);
    }
    check(count_slots(&store) == inserted, "another number of slots than of keys, when it was made wider");
    ex_store_free(&store);
}

/* --- threads ------------------------------------------------------------------------------------------------------ */

typedef struct job {
    ex_store_t *store;
    ex_tuples_t *tuples;
    ex_bytes_t *bytes;
    uint64_t start;
    uint64_t count;
    uint64_t fresh;
    uint32_t *number;
    uint32_t *name;
} job_t;

static const uint32_t s_widths[EX_KEY_WORDS] = { 30U, 30U, 10U, 0U };

static void *insert_all(void *user)
{
    job_t *const job = user;
    for (uint64_t k = 0U; k < job->count; k++) {
        const uint64_t i = ((k + job->start) % job->count) + 1U;
        const ex_key_t key = numbered(i, job->store->is_word ? s_word_widths : s_widths);
        const ex_insertion_t insertion = ex_store_insert(job->store, &key, ex_hash(&key), NULL);
        check(insertion != EX_FULL, "full");
        job->fresh += (insertion == EX_NEW) ? 1U : 0U;
        const uint64_t lane[EX_TUPLE_LANES] = { i * 3U, i << 20U, i ^ 5U, 0U };
        unsigned char text[64];
        const int length = snprintf((char *)text, sizeof text, "%0*llu", (int)(i % 40U) + 1, (unsigned long long)i);
        job->number[i - 1U] = ex_tuples_number(job->tuples, lane, ex_tuple_hash(lane, job->tuples->lanes));
        job->name[i - 1U] = ex_bytes_number(job->bytes, (uint32_t)(i % 7U), text, (uint32_t)length);
    }
    return NULL;
}

typedef struct watch {
    const ex_store_t *store;
    uint64_t used;
    _Atomic bool is_over;
} watch_t;

/* As one that tells how far an exploration is does, also while others are in a pause. */
static void *watch_used(void *user)
{
    watch_t *const watch = user;
    while (!atomic_load(&watch->is_over)) {
        check(atomic_load_explicit(&watch->store->used, memory_order_relaxed) == watch->used, "another number of keys");
    }
    return NULL;
}

static void try_watched(ex_store_t *store, uint64_t used)
{
    watch_t watch = { .store = store, .used = used };
    pthread_t thread;
    atomic_init(&watch.is_over, false);
    atomic_store(&store->used, used);
    check(pthread_create(&thread, NULL, watch_used, &watch) == 0, "no thread");
    for (uint32_t i = 0U; i < 3U; i++) {
        store->limit = 0U; /* as if it were full */
        check(ex_store_grow(store, store->is_word ? s_word_widths : s_widths), "it does not grow");
    }
    atomic_store(&watch.is_over, true);
    (void)pthread_join(thread, NULL);
    check(count_slots(store) == used, "keys are lost");
}

static void try_threads_on(bool is_word)
{
    const uint64_t count = 60000U;
    ex_store_t store;
    ex_tuples_t tuples;
    ex_bytes_t bytes;
    pthread_t thread[WORKERS];
    job_t job[WORKERS];
    ground_t ground = ground_of((uint64_t)1U << 30U);
    (void)memset(&tuples, 0, sizeof tuples);
    (void)memset(&bytes, 0, sizeof bytes);
    check(ex_store_make(&store, &ground.memory, &ground.team, is_word, is_word ? s_word_widths : s_widths,
                        (count * 5U) / 4U)
              && ex_tuples_make(&tuples, &ground.memory, &ground.team, 5U)
              && ex_bytes_make(&bytes, &ground.memory, &ground.team),
          "no memory");
    /* Threads that meet at something new take a number each, of which one is used: see ex_tuples_number. */
    while ((tuples.index.limit < (count * WORKERS)) || (bytes.index.limit < (count * WORKERS))) {
        /* As if they were nearly full. */
        atomic_store(&tuples.index.count, tuples.index.limit);
        atomic_store(&bytes.index.count, bytes.index.limit);
        check(ex_tuples_grow(&tuples) && ex_bytes_grow(&bytes), "it does not grow");
        atomic_store(&tuples.index.count, 0U);
        atomic_store(&bytes.index.count, 0U);
    }
    for (uint32_t w = 0U; w < (uint32_t)WORKERS; w++) {
        job[w] = (job_t){
            .store = &store, .tuples = &tuples, .bytes = &bytes, .start = (w % 2U) * (count / 3U), .count = count
        };
        job[w].number = calloc(count, sizeof(uint32_t));
        job[w].name = calloc(count, sizeof(uint32_t));
        check((job[w].number != NULL) && (job[w].name != NULL), "no memory");
        check(pthread_create(&thread[w], NULL, insert_all, &job[w]) == 0, "no thread");
    }
    uint64_t fresh = 0U;
    for (uint32_t w = 0U; w < (uint32_t)WORKERS; w++) {
        (void)pthread_join(thread[w], NULL);
        fresh += job[w].fresh;
    }
    check(fresh == count, "new more than once, or never");
    check(count_slots(&store) == count, "another number of slots than of keys");
    for (uint64_t i = 0U; i < count; i++) {
        for (uint32_t w = 1U; w < (uint32_t)WORKERS; w++) {
            check(job[w].number[i] == job[0].number[i], "threads have different numbers");
            check(job[w].name[i] == job[0].name[i], "threads have different numbers of texts");
        }
        check(tuples.lane[(uint64_t)job[0].number[i] * 3U] == ((i + 1U) * 3U), "the number of something else");
        check(bytes.of[job[0].name[i]].place == (uint32_t)((i + 1U) % 7U), "the number of another text");
    }
    for (uint32_t w = 0U; w < (uint32_t)WORKERS; w++) {
        free(job[w].number);
        free(job[w].name);
    }
    try_watched(&store, count);
    ex_store_free(&store);
}

static void try_threads(void)
{
    try_threads_on(false);
    try_threads_on(true);
}

/* --- meetings ----------------------------------------------------------------------------------------------------- */

/* Two threads that put the same key into the store at the same moment, again and again. */
typedef struct meeting {
    ex_store_t *store;
    _Atomic uint64_t *come; /* how often a thread has come to the next key: both together */
    uint64_t count;
    uint64_t fresh;
} meeting_t;

enum { TOGETHER = 2 };

static void *insert_at_once(void *user)
{
    meeting_t *const own = user;
    for (uint64_t k = 0U; k < own->count; k++) {
        const ex_key_t key = numbered(k + 1U, own->store->is_word ? s_word_widths : s_widths);
        const uint64_t hash = ex_hash(&key);
        (void)atomic_fetch_add(own->come, 1U);
        while (atomic_load(own->come) < ((k + 1U) * (uint64_t)TOGETHER)) {
            (void)sched_yield();
        }
        own->fresh += (ex_store_insert(own->store, &key, hash, NULL) == EX_NEW) ? 1U : 0U;
    }
    return NULL;
}

static void try_meetings_on(bool is_word)
{
    const uint64_t count = 200000U;
    ex_store_t store;
    pthread_t thread[TOGETHER];
    meeting_t meeting[TOGETHER];
    _Atomic uint64_t come;
    atomic_init(&come, 0U);
    ground_t ground = ground_of((uint64_t)1U << 30U);
    check(ex_store_make(&store, &ground.memory, &ground.team, is_word, is_word ? s_word_widths : s_widths,
                        (count * 5U) / 4U),
          "no memory");
    for (uint32_t i = 0U; i < (uint32_t)TOGETHER; i++) {
        meeting[i] = (meeting_t){ .store = &store, .come = &come, .count = count };
        check(pthread_create(&thread[i], NULL, insert_at_once, &meeting[i]) == 0, "no thread");
    }
    uint64_t fresh = 0U;
    for (uint32_t i = 0U; i < (uint32_t)TOGETHER; i++) {
        (void)pthread_join(thread[i], NULL);
        fresh += meeting[i].fresh;
    }
    check(fresh == count, "a key is new for two that meet");
    check(count_slots(&store) == count, "another number of slots than of keys that were met");
    ex_store_free(&store);
}

static void try_meetings(void)
{
    try_meetings_on(false);
    try_meetings_on(true);
}

/* --- numbers ------------------------------------------------------------------------------------------------------ */

static void try_numbers(void)
{
    const uint64_t count = 150000U;
    ex_tuples_t tuples;
    ex_bytes_t bytes;
    ground_t ground = ground_of((uint64_t)1U << 30U);
    (void)memset(&tuples, 0, sizeof tuples);
    (void)memset(&bytes, 0, sizeof bytes);
    check(ex_tuples_make(&tuples, &ground.memory, &ground.team, 5U)
              && ex_bytes_make(&bytes, &ground.memory, &ground.team),
          "no memory");
    uint32_t *const number = calloc(count, sizeof *number);
    uint32_t *const name = calloc(count, sizeof *name);
    check((number != NULL) && (name != NULL), "no memory");
    uint64_t given = 0U;
    for (uint64_t step = 0U; step < (3U * count); step++) {
        const uint64_t i = draw(count);
        const uint64_t lane[EX_TUPLE_LANES] = { i, ~i, i / 2U, 0U };
        unsigned char text[32] = { 0 };
        (void)memcpy(text, &i, sizeof i);
        const uint32_t length = (uint32_t)(i % 24U) + 8U;
        uint32_t found = ex_tuples_number(&tuples, lane, ex_tuple_hash(lane, tuples.lanes));
        uint32_t named = ex_bytes_number(&bytes, 3U, text, length);
        while (found == EX_NO_NUMBER) {
            check(ex_tuples_grow(&tuples), "it does not grow");
            found = ex_tuples_number(&tuples, lane, ex_tuple_hash(lane, tuples.lanes));
        }
        while (named == EX_NO_NUMBER) {
            check(ex_bytes_grow(&bytes), "it does not grow");
            named = ex_bytes_number(&bytes, 3U, text, length);
        }
        given += (number[i] == 0U) ? 1U : 0U;
        check((number[i] == 0U) || (number[i] == (found + 1U)), "another number than before");
        check((name[i] == 0U) || (name[i] == (named + 1U)), "another number of a text than before");
        number[i] = found + 1U;
        name[i] = named + 1U;
        check(memcmp(&tuples.lane[(uint64_t)found * 3U], lane, 3U * sizeof lane[0]) == 0,
              "the number of something else");
        check((bytes.of[named].length == length) && (memcmp(&bytes.byte[bytes.of[named].offset], text, length) == 0),
              "the number of another text");
    }
    check((atomic_load(&tuples.index.count) == given) && (atomic_load(&bytes.index.count) == given),
          "holes without threads");
    unsigned char text[8] = { 1U, 0U };
    check(ex_bytes_number(&bytes, 4U, text, 8U) != (name[1] - 1U), "places share a text");
    free(number);
    free(name);
}

/* --- memory ------------------------------------------------------------------------------------------------------- */

static void try_memory(void)
{
    ex_store_t store;
    const uint64_t limit = (uint64_t)6U << 20U;
    ground_t ground = ground_of(limit);
    check(ex_store_make(&store, &ground.memory, &ground.team, false, s_widths, 64U), "no memory");
    uint64_t inserted = 0U;
    for (uint64_t i = 1U;; i++) {
        const ex_key_t key = numbered(i, s_widths);
        check(ex_store_insert(&store, &key, ex_hash(&key), NULL) == EX_NEW, "not new");
        inserted++;
        atomic_store(&store.used, inserted);
        check(atomic_load(&ground.memory.used) <= limit, "more memory than allowed");
        if (((inserted + EX_SPARE_KEYS) >= store.limit) && !ex_store_grow(&store, s_widths)) {
            break;
        }
    }
    check(count_slots(&store) == inserted, "keys were lost when memory was used up");
    check((inserted * 16U) > (limit / 4U), "it gave up too early");
}

int main(int argc, char **argv)
{
    static const struct {
        const char *name;
        void (*try)(void);
    } s_parts[] = { { "store", try_stores },
                    { "threads", try_threads },
                    { "meetings", try_meetings },
                    { "numbers", try_numbers },
                    { "memory", try_memory } };
    s_random = (argc > 2) ? strtoull(argv[2], NULL, 10) : 1U;
    for (size_t i = 0U; (argc > 1) && (i < (sizeof s_parts / sizeof s_parts[0])); i++) {
        if (strcmp(argv[1], s_parts[i].name) == 0) {
            s_parts[i].try();
            (void)printf("fine\n");
            return 0;
        }
    }
    (void)printf("usage: explore_core store|threads|meetings|numbers|memory SEED\n");
    return 2;
}
