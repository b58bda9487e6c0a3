/* SPDX-License-Identifier: MIT
 * tables_ctl_search.c - the memory of a search, which is kept for the next one for the same operator: a search costs
 * what it meets, however many markings are known.
 */
#include "tables_ctl.h"

enum { FIRST_ROOM = 64 };

void tb_search_free(tb_search_t *s)
{
    tb_free(s->met, s->room, sizeof *s->met);
    tb_free(s->all, s->all_room, sizeof *s->all);
    tb_free(s->path, s->path_room, sizeof *s->path);
    tb_free(s->open, s->open_room, sizeof *s->open);
    tb_heap_free(&s->heap);
}

void tb_search_end(tb_search_t *s)
{
    for (uint32_t i = 0U; i < s->all_count; i++) {
        s->met[s->all[i].marking] = 0U;
    }
    s->all_count = 0U;
    s->path_count = 0U;
    s->open_count = 0U;
    s->heap.count = 0U;
}

uint32_t *tb_met(tb_checker_t *c, tb_search_t *s, uint32_t marking)
{
    if (marking >= s->room) {
        const uint64_t room = (c->graph.store.records > (2U * s->room)) ? c->graph.store.records : (2U * s->room);
        s->met = tb_grown(s->met, s->room, room, sizeof *s->met);
        s->room = room;
    }
    return &s->met[marking];
}

static uint32_t room_for(uint32_t room)
{
    return (room > 0U) ? (2U * room) : (uint32_t)FIRST_ROOM;
}

uint32_t tb_meet(tb_checker_t *c, tb_search_t *s, uint32_t marking, uint32_t from)
{
    if (s->all_count == s->all_room) {
        const uint32_t room = room_for(s->all_room);
        s->all = tb_grown(s->all, s->all_room, room, sizeof *s->all);
        s->all_room = room;
    }
    const tb_meeting_t meeting = { marking, from };
    s->all[s->all_count] = meeting;
    s->all_count++;
    *tb_met(c, s, marking) = s->all_count;
    return s->all_count;
}

void tb_enter(tb_checker_t *c, tb_search_t *s, uint32_t marking, bool is_doubtful)
{
    const uint32_t index = tb_meet(c, s, marking, 0U);
    if (s->path_count == s->path_room) {
        const uint32_t room = room_for(s->path_room);
        s->path = tb_grown(s->path, s->path_room, room, sizeof *s->path);
        s->path_room = room;
    }
    if (s->open_count == s->open_room) {
        const uint32_t room = room_for(s->open_room);
        s->open = tb_grown(s->open, s->open_room, room, sizeof *s->open);
        s->open_room = room;
    }
    const tb_frame_t frame = { marking, 0U, index, index, is_doubtful };
    s->path[s->path_count] = frame;
    s->path_count++;
    s->open[s->open_count] = marking;
    s->open_count++;
}
