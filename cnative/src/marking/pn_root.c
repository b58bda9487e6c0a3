/* SPDX-License-Identifier: MIT */
#include "pn/pn_root.h"

#include <string.h>

#include "pn/pn_arena.h"
#include "pn/pn_num.h"
#include "../value/pn_type_impl.h"

#define COUNT_SIZE sizeof(uint64_t) /* the bytes begin with the number of cells */

static uint64_t s_pass; /* one thread at a time: the roots are shared by all */

size_t pn_roots_encode(const pn_root_t *root, uint32_t count, uint8_t *out, size_t room)
{
    s_pass++;
    pn_cells_t cells = { .root = root, .roots = count, .pass = s_pass };
    size_t at = COUNT_SIZE;
    for (uint32_t i = 0U; i < count; i++) {
        at = pn_encode_with(&cells, root[i].type, root[i].variable, out, room, at);
    }
    if (room >= COUNT_SIZE) {
        (void)memcpy(out, &cells.count, COUNT_SIZE);
    }
    return at;
}

bool pn_roots_decode(pn_ctx_t *cx, const pn_root_t *root, uint32_t count, const uint8_t *in, size_t length)
{
    pn_cells_t cells = { .root = root, .roots = count };
    if (length < COUNT_SIZE) {
        return false;
    }
    (void)memcpy(&cells.most, in, COUNT_SIZE);
    if (cells.most > length) { /* each has bytes of its own */
        return false;
    }
    cells.contents = pn_arena_alloc(cx, ((size_t)cells.most + 1U) * sizeof *cells.contents);
    size_t at = COUNT_SIZE;
    for (uint32_t i = 0U; (cells.contents != NULL) && (at != SIZE_MAX) && (i < count); i++) {
        const size_t used = pn_decode_with(cx, &cells, root[i].type, root[i].variable, &in[at], length - at);
        at = (used == SIZE_MAX) ? SIZE_MAX : (at + used);
    }
    return pn_ok(cx) && (at == length) && (cells.count == cells.most);
}
