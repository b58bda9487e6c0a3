/* SPDX-License-Identifier: MIT
 * tables_store.c - known markings, packed into words.
 *
 * Each place has as many bits as its largest number of tokens so far needs. When a marking does not fit, the place gets
 * twice as many bits and all records are packed anew: that happens a few times at the beginning, and no bound has to be
 * known beforehand.
 */
#include "tables.h"

#include <string.h>

enum { FIRST_ROOM = 1 << 10, WORD = 64, WIDEST = 32 };

static void lay_out(tb_store_t *s)
{
    uint32_t bit = 0U;
    for (uint32_t p = 0U; p < s->places; p++) {
        if (((bit % (uint32_t)WORD) + s->width[p]) > (uint32_t)WORD) {
            bit += (uint32_t)WORD - (bit % (uint32_t)WORD);
        }
        s->at[p] = bit;
        bit += s->width[p];
    }
    s->words = (bit + (uint32_t)WORD - 1U) / (uint32_t)WORD;
    s->words = (s->words > 0U) ? s->words : 1U;
}

static uint8_t bits_for(tb_count_t tokens)
{
    uint8_t bits = 1U;
    while ((bits < (uint8_t)WIDEST) && ((tokens >> bits) != 0U)) {
        bits++;
    }
    return bits;
}

void tb_store_init(tb_store_t *s, const tb_net_t *net, const tb_count_t *most)
{
    (void)memset(s, 0, sizeof *s);
    s->places = net->places;
    s->width = tb_new(net->places, sizeof *s->width);
    s->at = tb_new(net->places, sizeof *s->at);
    for (uint32_t p = 0U; p < net->places; p++) {
        const tb_count_t known = ((most != NULL) && (most[p] > net->initial[p])) ? most[p] : net->initial[p];
        s->width[p] = bits_for(known);
    }
    lay_out(s);
    s->room = (uint64_t)FIRST_ROOM;
    s->slots = 2U * (uint64_t)FIRST_ROOM;
    s->record = tb_new(s->room * s->words, sizeof *s->record);
    s->slot = tb_new(s->slots, sizeof *s->slot);
    s->packed = tb_new(s->words, sizeof *s->packed);
}

void tb_store_free(tb_store_t *s)
{
    tb_free(s->width, s->places, sizeof *s->width);
    tb_free(s->at, s->places, sizeof *s->at);
    tb_free(s->record, s->room * s->words, sizeof *s->record);
    tb_free(s->slot, s->slots, sizeof *s->slot);
    tb_free(s->packed, s->words, sizeof *s->packed);
    (void)memset(s, 0, sizeof *s);
}

static void unpack(const tb_store_t *s, const uint64_t *record, tb_count_t *marking)
{
    for (uint32_t p = 0U; p < s->places; p++) {
        const uint64_t mask = ((uint64_t)1 << s->width[p]) - 1U;
        marking[p] = (tb_count_t)((record[s->at[p] / (uint32_t)WORD] >> (s->at[p] % (uint32_t)WORD)) & mask);
    }
}

/* The first place that does not fit, or `places`. */
static uint32_t pack(const tb_store_t *s, const tb_count_t *marking, uint64_t *record)
{
    (void)memset(record, 0, s->words * sizeof *record);
    for (uint32_t p = 0U; p < s->places; p++) {
        if (((uint64_t)marking[p] >> s->width[p]) != 0U) {
            return p;
        }
        record[s->at[p] / (uint32_t)WORD] |= (uint64_t)marking[p] << (s->at[p] % (uint32_t)WORD);
    }
    return s->places;
}

static uint64_t hash_of(const uint64_t *record, uint32_t words)
{
    uint64_t hash = 0x9e3779b97f4a7c15U;
    for (uint32_t i = 0U; i < words; i++) {
        hash = (hash ^ record[i]) * 0xbf58476d1ce4e5b9U;
        hash ^= hash >> 29U;
    }
    hash *= 0x94d049bb133111ebU;
    return hash ^ (hash >> 31U);
}

/* The slot of a record: where it is, or the empty one where it belongs. */
static uint64_t slot_of(const tb_store_t *s, const uint64_t *record)
{
    uint64_t at = hash_of(record, s->words) & (s->slots - 1U);
    while ((s->slot[at] != 0U)
           && (memcmp(&s->record[(uint64_t)(s->slot[at] - 1U) * s->words], record, s->words * sizeof *record) != 0)) {
        at = (at + 1U) & (s->slots - 1U);
    }
    return at;
}

static void enter_all(tb_store_t *s)
{
    (void)memset(s->slot, 0, s->slots * sizeof *s->slot);
    for (uint64_t i = 0U; i < s->records; i++) {
        s->slot[slot_of(s, &s->record[i * s->words])] = (uint32_t)(i + 1U);
    }
}

/* False: there is no room. */
static bool widen(tb_store_t *s, uint32_t place, tb_count_t tokens)
{
    const tb_store_t old = *s;
    uint8_t *width = tb_new(s->places, sizeof *width);
    uint32_t *at = tb_new(s->places, sizeof *at);
    (void)memcpy(width, s->width, s->places);
    s->width = width;
    s->at = at;
    const uint8_t doubled = (uint8_t)(2U * old.width[place]);
    const uint8_t needed = bits_for(tokens);
    s->width[place] = (doubled > needed) ? ((doubled < (uint8_t)WIDEST) ? doubled : (uint8_t)WIDEST) : needed;
    lay_out(s);
    if (!tb_has_room((s->room * s->words * sizeof *s->record) + (s->places * sizeof(tb_count_t)))) {
        *s = old;
        tb_free(width, s->places, sizeof *width);
        tb_free(at, s->places, sizeof *at);
        return false;
    }
    s->record = tb_new(s->room * s->words, sizeof *s->record);
    s->packed = tb_new(s->words, sizeof *s->packed);
    tb_count_t *marking = tb_new(s->places, sizeof *marking);
    for (uint64_t i = 0U; i < s->records; i++) {
        unpack(&old, &old.record[i * old.words], marking);
        (void)pack(s, marking, &s->record[i * s->words]);
    }
    tb_free(marking, s->places, sizeof *marking);
    enter_all(s);
    tb_free(old.width, s->places, sizeof *old.width);
    tb_free(old.at, s->places, sizeof *old.at);
    tb_free(old.record, old.room * old.words, sizeof *old.record);
    tb_free(old.packed, old.words, sizeof *old.packed);
    return true;
}

/* False: there is no room. Slots grow first, so that there are always more of them than records. */
static bool grow(tb_store_t *s)
{
    const uint64_t room = (s->room < ((uint64_t)1 << 22U)) ? (2U * s->room) : (s->room + (s->room / 2U));
    const uint64_t more = (room - s->room) * s->words * sizeof *s->record;
    uint64_t slots = s->slots;
    while (slots < ((3U * room) / 2U)) {
        slots *= 2U;
    }
    const uint64_t more_slots = (slots - s->slots) * sizeof *s->slot;
    if ((room >= UINT32_MAX) || !tb_has_room(more + more_slots)) {
        return false;
    }
    s->record = tb_grown(s->record, s->room * s->words, room * s->words, sizeof *s->record);
    s->room = room;
    if (slots != s->slots) {
        tb_free(s->slot, s->slots, sizeof *s->slot);
        s->slots = slots;
        s->slot = tb_new(s->slots, sizeof *s->slot);
        enter_all(s);
    }
    return true;
}

tb_added_t tb_store_add(tb_store_t *s, const tb_count_t *marking, uint32_t *number)
{
    uint32_t wide = pack(s, marking, s->packed);
    while (wide < s->places) {
        if (!widen(s, wide, marking[wide])) {
            return TB_FULL;
        }
        wide = pack(s, marking, s->packed);
    }
    uint64_t at = slot_of(s, s->packed);
    if (s->slot[at] != 0U) {
        *number = s->slot[at] - 1U;
        return TB_KNOWN;
    }
    if (s->records == s->room) {
        if (!grow(s)) {
            return TB_FULL;
        }
        at = slot_of(s, s->packed);
    }
    (void)memcpy(&s->record[s->records * s->words], s->packed, s->words * sizeof *s->packed);
    s->records++;
    s->slot[at] = (uint32_t)s->records;
    *number = (uint32_t)(s->records - 1U);
    return TB_ADDED;
}

void tb_store_get(const tb_store_t *s, uint32_t number, tb_count_t *marking)
{
    unpack(s, &s->record[(uint64_t)number * s->words], marking);
}
