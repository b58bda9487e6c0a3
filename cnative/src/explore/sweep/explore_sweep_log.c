/* SPDX-License-Identifier: MIT
 * explore_sweep_log.c - how each state was found, in a file.
 *
 * States are forgotten, so the way to one of them is read from here: an entry for each in the order in which they were
 * found, with its key and the number of the state from which it was found first. Keys stay what they are while the
 * search goes on, but for one time (explore_layout.c).
 */
#define _POSIX_C_SOURCE 200809L /* mkstemp, fseeko */

#include "explore_sweep_log.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define ENTRY_SIZE (sizeof(ex_key_t) + EX_INDEX_BYTES)
#define BLOCK      512U

static size_t stride_of(const ex_sweep_log_t *log)
{
    return (size_t)log->length + EX_INDEX_BYTES;
}

static void close_log(ex_sweep_log_t *log)
{
    if (log->file != NULL) {
        (void)fclose(log->file);
        log->file = NULL;
        log->is_lost = true;
    }
}

void ex_sweep_log_open(ex_sweep_log_t *log, const char *folder, uint32_t length)
{
    char path[EX_LOG_PATH_SIZE];
    const int size = snprintf(path, sizeof path, "%s/sweep-XXXXXX", folder);
    *log = (ex_sweep_log_t){ .length = length };
    const int file = ((size > 0) && ((size_t)size < sizeof path)) ? mkstemp(path) : -1;
    if (file >= 0) {
        (void)unlink(path);
        log->file = fdopen(file, "w+b");
    }
    if ((log->file == NULL) && (file >= 0)) {
        (void)close(file);
    }
    log->is_lost = log->file == NULL;
}

void ex_sweep_log_add(ex_sweep_log_t *log, const ex_key_t *key, uint64_t parent)
{
    unsigned char entry[ENTRY_SIZE];
    if (log->file == NULL) {
        return;
    }
    (void)memcpy(entry, key, log->length);
    (void)memcpy(&entry[log->length], &parent, EX_INDEX_BYTES);
    if (fwrite(entry, stride_of(log), 1U, log->file) != 1U) {
        close_log(log); /* half of it is worth nothing */
    }
    log->count++;
}

/* False: it cannot be read. */
static bool read_entry(const ex_sweep_log_t *log, uint64_t index, ex_key_t *key, uint64_t *parent)
{
    unsigned char entry[ENTRY_SIZE];
    if ((fseeko(log->file, (off_t)(index * stride_of(log)), SEEK_SET) != 0)
        || (fread(entry, stride_of(log), 1U, log->file) != 1U)) {
        return false;
    }
    *key = (ex_key_t){ 0U, 0U };
    *parent = 0U;
    (void)memcpy(key, entry, log->length);
    (void)memcpy(parent, &entry[log->length], EX_INDEX_BYTES);
    return true;
}

/* So many entries at most, from a number on, with other keys. False: they cannot be read or written. */
static bool replace_block(const ex_sweep_log_t *log, uint64_t from, uint64_t count, ex_replace_t one,
                          const void *layout)
{
    unsigned char block[BLOCK * ENTRY_SIZE];
    const size_t stride = stride_of(log);
    const off_t at = (off_t)(from * stride);
    if ((fseeko(log->file, at, SEEK_SET) != 0) || (fread(block, stride, count, log->file) != count)) {
        return false;
    }
    for (uint64_t i = 0U; i < count; i++) {
        ex_key_t key = { 0U, 0U };
        (void)memcpy(&key, &block[i * stride], log->length);
        one(layout, &key);
        (void)memcpy(&block[i * stride], &key, log->length);
    }
    return (fseeko(log->file, at, SEEK_SET) == 0) && (fwrite(block, stride, count, log->file) == count);
}

void ex_sweep_log_replace(ex_sweep_log_t *log, ex_replace_t one, const void *layout)
{
    bool is_fine = true;
    for (uint64_t i = 0U; is_fine && (log->file != NULL) && (i < log->count); i += BLOCK) {
        const uint64_t left = log->count - i;
        is_fine = replace_block(log, i, (left < BLOCK) ? left : BLOCK, one, layout);
    }
    if (!is_fine || ((log->file != NULL) && (fseeko(log->file, 0, SEEK_END) != 0))) {
        close_log(log);
    }
}

ex_key_t *ex_sweep_log_way(const ex_sweep_log_t *log, uint64_t index, uint64_t *steps)
{
    ex_key_t key;
    uint64_t parent;
    uint64_t length = 0U;
    if ((log->file == NULL) || (fflush(log->file) != 0)) {
        return NULL;
    }
    for (uint64_t at = index; at != 0U; at = parent) {
        if (!read_entry(log, at, &key, &parent)) {
            return NULL;
        }
        length++;
    }
    ex_key_t *const way = calloc(length + 1U, sizeof *way);
    uint64_t at = index;
    for (uint64_t i = length + 1U; (way != NULL) && (i > 0U); i--) {
        if (!read_entry(log, at, &way[i - 1U], &parent)) {
            free(way);
            return NULL;
        }
        at = parent;
    }
    *steps = length;
    return way;
}
