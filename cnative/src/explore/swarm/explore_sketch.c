/* SPDX-License-Identifier: MIT
 * explore_sketch.c - of all states that were seen those with the least hashes.
 *
 * Keys depend on the order in which a search has met the multi-sets of its places. So the hash is one of the contents:
 * the packed places as they are, and the canonical bytes of all others. Equal markings have equal hashes in all
 * searches by the same program. As the hashes are as good as random numbers, the least ones of a union of sets are a
 * sample of it, and it is known of each of them in which of the sets it is.
 */
#include "../explore_run.h"
#include "../state/explore_multiset.h"
#include "explore_sketch.h"

#include <inttypes.h>
#include <string.h>

enum { FIRST_CONTENTS = 1 << 10 };

bool ex_sketch_make(ex_worker_t *worker, ex_sketch_t *sketch, uint32_t most)
{
    sketch->most = most;
    if (most > 0U) {
        sketch->least = ex_table(&worker->run->memory, most, sizeof *sketch->least);
    }
    return (most == 0U) || (sketch->least != NULL);
}

static uint64_t mixed(uint64_t hash, uint64_t word)
{
    const ex_key_t key = { word ^ 0x2545f4914f6cdd1dU, hash };
    return ex_hash(&key);
}

static uint64_t hash_of(uint64_t hash, const unsigned char *byte, size_t length)
{
    size_t at = 0U;
    for (; (length - at) >= sizeof(uint64_t); at += sizeof(uint64_t)) {
        uint64_t word;
        (void)memcpy(&word, &byte[at], sizeof word);
        hash = mixed(hash, word);
    }
    uint64_t rest = 0U;
    (void)memcpy(&rest, &byte[at], length - at);
    return mixed(mixed(hash, rest), length);
}

/* Room for the contents of all numbers that were given. */
static bool grow(ex_worker_t *worker, ex_sketch_t *sketch, uint64_t count)
{
    ex_memory_t *const memory = &worker->run->memory;
    uint64_t larger = (sketch->contents > 0U) ? sketch->contents : (uint64_t)FIRST_CONTENTS;
    while (larger < count) {
        larger *= 2U;
    }
    uint64_t *const content = ex_table(memory, larger, sizeof *content);
    if (content == NULL) {
        ex_stop(worker->run, EX_MEMORY);
        worker->failed = true;
        return false;
    }
    if (sketch->content != NULL) {
        (void)memcpy(content, sketch->content, sketch->contents * sizeof *content);
        ex_free_table(memory, sketch->content, sketch->contents, sizeof *content);
    }
    sketch->content = content;
    sketch->contents = larger;
    return true;
}

/* What has a number, as a hash. */
static bool content_of(ex_worker_t *worker, ex_sketch_t *sketch, uint32_t number, uint64_t *hash)
{
    const ex_bytes_t *const bytes = &worker->run->codec->bytes;
    if (((uint64_t)number >= sketch->contents) && !grow(worker, sketch, (uint64_t)number + 1U)) {
        return false;
    }
    if (sketch->content[number] == 0U) {
        const ex_bytes_entry_t *const of = &bytes->of[number];
        const bool is_multiset = !worker->run->codec->is_whole && (of->place < pn_net.place_count);
        const unsigned char *byte = &bytes->byte[of->offset];
        size_t length = of->length;
        if (is_multiset) {
            byte = ex_multiset_bytes(worker, number, &length);
        }
        if (byte == NULL) {
            return false;
        }
        const uint64_t found = hash_of(of->place, byte, length);
        sketch->content[number] = (found != 0U) ? found : 1U;
    }
    *hash = sketch->content[number];
    return true;
}

/* Takes a hash, unless there are enough that are less. */
static void take(ex_sketch_t *sketch, uint64_t hash)
{
    uint32_t low = 0U;
    uint32_t high = sketch->count;
    while (low < high) {
        const uint32_t middle = low + ((high - low) / 2U);
        if (sketch->least[middle] < hash) {
            low = middle + 1U;
        } else {
            high = middle;
        }
    }
    const bool is_full = sketch->count == sketch->most;
    if ((low == sketch->most) || ((low < sketch->count) && (sketch->least[low] == hash))) {
        return;
    }
    const uint32_t after = sketch->count - low - (is_full ? 1U : 0U);
    (void)memmove(&sketch->least[low + 1U], &sketch->least[low], after * sizeof *sketch->least);
    sketch->least[low] = hash;
    sketch->count += is_full ? 0U : 1U;
}

bool ex_sketch_see(ex_worker_t *worker, ex_sketch_t *sketch, const ex_key_t *key)
{
    const ex_codec_t *const codec = worker->run->codec;
    if (sketch->most == 0U) {
        return true;
    }
    if (!ex_open(worker, key)) {
        return false;
    }
    uint64_t hash = hash_of(0U, worker->marking, pn_net.packed_size);
    for (uint32_t w = codec->packed_words; !codec->is_plain && (w < codec->words); w++) {
        uint64_t content = 0U;
        if (!content_of(worker, sketch, worker->scratch->cell[w], &content)) {
            return false;
        }
        hash = mixed(hash, content);
    }
    if ((sketch->count < sketch->most) || (hash < sketch->least[sketch->count - 1U])) {
        take(sketch, hash);
    }
    return true;
}

void ex_sketch_json(const ex_sketch_t *sketch, FILE *out)
{
    (void)fprintf(out, "[");
    for (uint32_t i = 0U; i < sketch->count; i++) {
        (void)fprintf(out, "%s%" PRIu64, (i > 0U) ? ", " : "", sketch->least[i]);
    }
    (void)fprintf(out, "]");
}
