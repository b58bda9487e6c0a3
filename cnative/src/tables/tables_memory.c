/* SPDX-License-Identifier: MIT
 * tables_memory.c - memory with a limit, and a clock that is cheap to look at.
 */
#define _POSIX_C_SOURCE 200809L
#include "tables.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { LOOKS = 1 << 10 /* calls of tb_is_over between two looks at the clock */ };

static uint64_t used;
static uint64_t most = UINT64_MAX;
static double begun;
static double limit = 1e300;
static uint32_t looks;
static bool is_over;

void tb_fail(int code, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    (void)fflush(stdout);
    (void)vfprintf(stderr, format, arguments);
    (void)fputc('\n', stderr);
    va_end(arguments);
    exit(code);
}

void tb_limit_memory(uint64_t bytes)
{
    most = bytes;
}

bool tb_has_room(uint64_t bytes)
{
    return (used + bytes) <= most;
}

void *tb_new(size_t count, size_t size)
{
    const uint64_t bytes = (uint64_t)count * size;
    void *memory = tb_has_room(bytes) ? calloc((count > 0U) ? count : 1U, size) : NULL;
    if (memory == NULL) {
        tb_fail(TB_EXIT_MEMORY, "memory is exhausted");
    }
    used += bytes;
    return memory;
}

void *tb_grown(void *old, size_t old_count, size_t count, size_t size)
{
    const uint64_t more = (uint64_t)(count - old_count) * size;
    void *memory = tb_has_room(more) ? realloc(old, count * size) : NULL;
    if (memory == NULL) {
        tb_fail(TB_EXIT_MEMORY, "memory is exhausted");
    }
    (void)memset((char *)memory + (old_count * size), 0, more);
    used += more;
    return memory;
}

void tb_free(void *memory, size_t count, size_t size)
{
    used -= (memory != NULL) ? ((uint64_t)count * size) : 0U;
    free(memory);
}

static double now(void)
{
    struct timespec t;
    (void)clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + (1e-9 * (double)t.tv_nsec);
}

void tb_start_clock(double seconds)
{
    begun = now();
    limit = seconds;
    looks = 0U;
    is_over = false;
}

void tb_limit_time(double until)
{
    limit = until;
    is_over = tb_elapsed() >= limit;
}

double tb_elapsed(void)
{
    return now() - begun;
}

bool tb_is_over(void)
{
    looks++;
    if (!is_over && ((looks % (uint32_t)LOOKS) == 0U)) {
        is_over = tb_elapsed() >= limit;
    }
    return is_over;
}
