/* SPDX-License-Identifier: MIT
 * no_heap.c - stops a program that asks for memory: preloaded (LD_PRELOAD), these come before the C library's.
 */
#include <stddef.h>
#include <unistd.h>

void *malloc(size_t size);
void *calloc(size_t count, size_t size);
void *realloc(void *old, size_t size);
void free(void *old);

static void *stop(const char *what, size_t length)
{
    (void)!write(STDERR_FILENO, what, length);
    _exit(99);
}

void *malloc(size_t size)
{
    (void)size;
    return stop("malloc is called\n", 17U);
}

void *calloc(size_t count, size_t size)
{
    (void)count;
    (void)size;
    return stop("calloc is called\n", 17U);
}

void *realloc(void *old, size_t size)
{
    (void)old;
    (void)size;
    return stop("realloc is called\n", 18U);
}

void free(void *old)
{
    if (old != NULL) {
        (void)stop("free is called\n", 15U);
    }
}
