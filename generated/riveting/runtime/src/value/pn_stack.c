/* SPDX-License-Identifier: MIT
 * pn_stack.c - how far functions of the net may recurse: as far as the stack reaches, where the system tells how far
 * that is.
 */
#define _POSIX_C_SOURCE 200809L

#include "pn/pn_num.h"

#if defined(__GNUC__) && (defined(__unix__) || defined(__APPLE__))

#include <sys/resource.h>

/* Asked for if there is less. Systems keep at least 128 MB of addresses free below the stack of a process. */
#define WANTED ((rlim_t)96U << 20U)
/* Kept for what does not count its calls: the runtime, the C library, the host. */
#define RESERVE ((rlim_t)1U << 20U)

void pn_stack_init(pn_ctx_t *cx)
{
    struct rlimit limit;
    cx->stack_limit = 0U;
    if (getrlimit(RLIMIT_STACK, &limit) != 0) {
        return;
    }
    rlim_t size = limit.rlim_cur;
    if (size < WANTED) {
        limit.rlim_cur = (limit.rlim_max < WANTED) ? limit.rlim_max : WANTED;
        size = (setrlimit(RLIMIT_STACK, &limit) == 0) ? limit.rlim_cur : size;
    }
    size = (size < WANTED) ? size : WANTED;
    const uintptr_t here = (uintptr_t)__builtin_frame_address(0);
    if ((size > (2U * RESERVE)) && (here > size)) {
        cx->stack_limit = here - (uintptr_t)(size - RESERVE);
    }
}

#else

void pn_stack_init(pn_ctx_t *cx)
{
    cx->stack_limit = 0U;
}

#endif
