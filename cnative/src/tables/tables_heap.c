/* SPDX-License-Identifier: MIT
 * tables_heap.c - markings that wait, the nearest first, and of equal ones the oldest.
 */
#include "tables.h"

enum { FIRST_WAITING = 1 << 8 };

static bool comes_before(const tb_waiting_t *a, const tb_waiting_t *b)
{
    return (a->distance < b->distance) || (!(a->distance > b->distance) && (a->number < b->number));
}

void tb_heap_free(tb_heap_t *h)
{
    tb_free(h->item, h->room, sizeof *h->item);
    h->item = NULL;
    h->count = 0U;
    h->room = 0U;
}

void tb_heap_push(tb_heap_t *h, double distance, uint32_t number)
{
    if (h->count == h->room) {
        const uint32_t room = (h->room > 0U) ? (2U * h->room) : (uint32_t)FIRST_WAITING;
        h->item = tb_grown(h->item, h->room, room, sizeof *h->item);
        h->room = room;
    }
    const tb_waiting_t item = { distance, number };
    uint32_t at = h->count;
    h->count++;
    while ((at > 0U) && comes_before(&item, &h->item[(at - 1U) / 2U])) {
        h->item[at] = h->item[(at - 1U) / 2U];
        at = (at - 1U) / 2U;
    }
    h->item[at] = item;
}

uint32_t tb_heap_pop(tb_heap_t *h)
{
    const uint32_t first = h->item[0].number;
    h->count--;
    const tb_waiting_t item = h->item[h->count];
    uint32_t at = 0U;
    for (uint32_t child = 1U; child < h->count; child = (2U * at) + 1U) {
        if (((child + 1U) < h->count) && comes_before(&h->item[child + 1U], &h->item[child])) {
            child++;
        }
        if (!comes_before(&h->item[child], &item)) {
            break;
        }
        h->item[at] = h->item[child];
        at = child;
    }
    h->item[at] = item;
    return first;
}
