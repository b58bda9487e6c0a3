/* SPDX-License-Identifier: MIT
 * conform_tables.c - the constant tables of a program under test as JSON, to be compared with cell.toml and the net.
 * What only words of messages are made of (the version, origins) is left out.
 */
#include "conform_tables.h"

#include "pn/pn_cell.h"
#include "pn/pn_marking.h"
#include "pn/pn_net.h"

static void member(pn_text_t *text, const char *name)
{
    pn_text_str(text, (text->buffer[text->length - 1U] == '{') ? "" : ", ");
    pn_text_json_str(text, name);
    pn_text_str(text, ": ");
}

static void text_member(pn_text_t *text, const char *name, const char *value)
{
    member(text, name);
    pn_text_json_str(text, value);
}

static void int_member(pn_text_t *text, const char *name, int64_t value)
{
    member(text, name);
    pn_text_int(text, value);
}

static void bool_member(pn_text_t *text, const char *name, bool value)
{
    member(text, name);
    pn_text_str(text, value ? "true" : "false");
}

/* Writes entry `i` of a table of the program. */
typedef void (*entry_writer_t)(pn_text_t *text, const void *table, uint32_t i);

static void array_member(pn_text_t *text, const char *name, uint32_t count, entry_writer_t write_entry,
                         const void *table)
{
    member(text, name);
    pn_text_char(text, '[');
    for (uint32_t i = 0U; i < count; i++) {
        pn_text_str(text, (i > 0U) ? ", " : "");
        write_entry(text, table, i);
    }
    pn_text_char(text, ']');
}

static void real_member(pn_text_t *text, const char *name, double value)
{
    member(text, name);
    pn_text_json_real(text, value);
}

static void index_entry(pn_text_t *text, const void *table, uint32_t i)
{
    const uint32_t *const index = table;
    pn_text_uint(text, index[i]);
}

static void name_entry(pn_text_t *text, const void *table, uint32_t i)
{
    const char *const *const name = table;
    pn_text_json_str(text, name[i]);
}

static void scalar_entry(pn_text_t *text, const void *table, uint32_t i)
{
    const pn_scalar_t *const own = &((const pn_scalar_t *)table)[i];
    pn_text_char(text, '{');
    int_member(text, "kind", (int64_t)own->kind);
    text_member(text, "label", own->label);
    text_member(text, "colset", own->colset);
    bool_member(text, "bounded", own->bounded);
    int_member(text, "low", own->low);
    int_member(text, "high", own->high);
    real_member(text, "real_low", own->real_low);
    real_member(text, "real_high", own->real_high);
    array_member(text, "names", own->name_count, name_entry, own->name);
    int_member(text, "elements", (int64_t)own->element_count);
    pn_text_char(text, '}');
}

static void channel_entry(pn_text_t *text, const void *table, uint32_t i)
{
    const pn_cell_channel_t *const own = &((const pn_cell_channel_t *)table)[i];
    pn_text_char(text, '{');
    text_member(text, "name", own->name);
    text_member(text, "file", own->file);
    int_member(text, "place", (int64_t)own->place);
    text_member(text, "place_name", own->place_name);
    text_member(text, "direction", (own->direction == PN_CHANNEL_OUT) ? "out" : "in");
    text_member(text, "kind", (own->kind == PN_CHANNEL_DATA) ? "data" : "flag");
    text_member(text, "peer", (own->peer < pn_cell.peer_count) ? pn_cell.peer[own->peer].name : "?");
    array_member(text, "scalars", own->scalar_count, scalar_entry, own->scalar);
    pn_text_char(text, '}');
}

static void input_entry(pn_text_t *text, const void *table, uint32_t i)
{
    const pn_cell_input_t *const own = &((const pn_cell_input_t *)table)[i];
    pn_text_char(text, '{');
    text_member(text, "name", own->name);
    text_member(text, "file", own->file);
    int_member(text, "place", (int64_t)own->place);
    text_member(text, "place_name", own->place_name);
    array_member(text, "scalars", own->scalar_count, scalar_entry, own->scalar);
    int_member(text, "checked", own->is_checked ? (int64_t)own->checked : -1);
    pn_text_char(text, '}');
}

static void peer_entry(pn_text_t *text, const void *table, uint32_t i)
{
    const pn_cell_peer_t *const own = &((const pn_cell_peer_t *)table)[i];
    pn_text_char(text, '{');
    text_member(text, "name", own->name);
    int_member(text, "owner", own->owner);
    pn_text_char(text, '}');
}

static void between_entry(pn_text_t *text, const void *table, uint32_t i)
{
    pn_text_json_str(text, ((const char *const *)table)[i]);
}

static void cell_tables(pn_text_t *text)
{
    text_member(text, "name", pn_cell.name);
    text_member(text, "digest", pn_cell.digest);
    text_member(text, "side", pn_cell.side);
    int_member(text, "owner", pn_cell.owner);
    real_member(text, "reply_timeout_s", pn_cell.reply_timeout_s);
    int_member(text, "arena", (int64_t)pn_cell.arena_size);
    array_member(text, "channels", pn_cell.channel_count, channel_entry, pn_cell.channel);
    array_member(text, "between", pn_cell.between_count, between_entry, pn_cell.between);
    array_member(text, "inputs", pn_cell.input_count, input_entry, pn_cell.input);
    array_member(text, "peers", pn_cell.peer_count, peer_entry, pn_cell.peer);
    array_member(text, "final", pn_cell.final_count, index_entry, pn_cell.final_place);
}

static void owner_entry(pn_text_t *text, const void *table, uint32_t i)
{
    pn_text_json_str(text, ((const pn_owner_t *)table)[i].name);
}

static void place_entry(pn_text_t *text, const void *table, uint32_t i)
{
    const pn_place_t *const own = &((const pn_place_t *)table)[i];
    pn_text_char(text, '{');
    text_member(text, "name", own->name);
    text_member(text, "colset", own->colset);
    int_member(text, "owner", own->owner);
    bool_member(text, "timed", own->multiset->is_timed);
    int_member(text, "bound", own->is_bounded ? (int64_t)own->bound : -1);
    pn_text_char(text, '}');
}

static void transition_entry(pn_text_t *text, const void *table, uint32_t i)
{
    const pn_transition_t *const own = &((const pn_transition_t *)table)[i];
    pn_text_char(text, '{');
    text_member(text, "name", own->name);
    text_member(text, "id", own->id);
    int_member(text, "owner", own->owner);
    int_member(text, "priority", own->priority);
    pn_text_char(text, '}');
}

static void net_tables(pn_text_t *text)
{
    text_member(text, "name", pn_net.name);
    text_member(text, "source", pn_net.source);
    text_member(text, "digest", pn_net.digest);
    bool_member(text, "timed", pn_net.timed);
    bool_member(text, "real_time", pn_net.real_time);
    array_member(text, "owners", pn_net.owner_count, owner_entry, pn_net.owner);
    array_member(text, "order", pn_net.order_count, index_entry, pn_net.order);
    array_member(text, "places", pn_net.place_count, place_entry, pn_net.place);
    array_member(text, "transitions", pn_net.transition_count, transition_entry, pn_net.transition);
}

void conform_tables(pn_text_t *text)
{
    pn_text_str(text, "{\"cell\": {");
    cell_tables(text);
    pn_text_str(text, "}, \"net\": {");
    net_tables(text);
    pn_text_str(text, "}}");
}
