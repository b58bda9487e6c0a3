/* SPDX-License-Identifier: MIT
 * conform_tables.c - the constant tables of a program under test as JSON, to be compared with cell.toml and the net. What only words of
 * messages are made of (the version, origins) is left out.
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

static void between(pn_text_t *text, uint32_t i)
{
    pn_text_str(text, (i > 0U) ? ", " : "");
}

static void scalars_member(pn_text_t *text, const pn_scalar_t *scalar, uint32_t count)
{
    member(text, "scalars");
    pn_text_char(text, '[');
    for (uint32_t i = 0U; i < count; i++) {
        const pn_scalar_t *const own = &scalar[i];
        between(text, i);
        pn_text_char(text, '{');
        int_member(text, "kind", (int64_t)own->kind);
        text_member(text, "label", own->label);
        text_member(text, "colset", own->colset);
        bool_member(text, "bounded", own->bounded);
        int_member(text, "low", own->low);
        int_member(text, "high", own->high);
        member(text, "real_low");
        pn_text_json_real(text, own->real_low);
        member(text, "real_high");
        pn_text_json_real(text, own->real_high);
        member(text, "names");
        pn_text_char(text, '[');
        for (uint32_t k = 0U; k < own->name_count; k++) {
            between(text, k);
            pn_text_json_str(text, own->name[k]);
        }
        pn_text_str(text, "]}");
    }
    pn_text_char(text, ']');
}

static void cell_tables(pn_text_t *text)
{
    text_member(text, "name", pn_cell.name);
    text_member(text, "digest", pn_cell.digest);
    text_member(text, "side", pn_cell.side);
    int_member(text, "owner", pn_cell.owner);
    member(text, "reply_timeout_s");
    pn_text_json_real(text, pn_cell.reply_timeout_s);
    int_member(text, "arena", (int64_t)pn_cell.arena_size);
    member(text, "channels");
    pn_text_char(text, '[');
    for (uint32_t i = 0U; i < pn_cell.channel_count; i++) {
        const pn_cell_channel_t *const own = &pn_cell.channel[i];
        between(text, i);
        pn_text_char(text, '{');
        text_member(text, "name", own->name);
        text_member(text, "file", own->file);
        int_member(text, "place", (int64_t)own->place);
        text_member(text, "place_name", own->place_name);
        text_member(text, "direction", (own->direction == PN_CHANNEL_OUT) ? "out" : "in");
        text_member(text, "kind", (own->kind == PN_CHANNEL_DATA) ? "data" : "flag");
        text_member(text, "peer", (own->peer < pn_cell.peer_count) ? pn_cell.peer[own->peer].name : "?");
        scalars_member(text, own->scalar, own->scalar_count);
        pn_text_char(text, '}');
    }
    pn_text_char(text, ']');
    member(text, "between");
    pn_text_char(text, '[');
    for (uint32_t i = 0U; i < pn_cell.between_count; i++) {
        between(text, i);
        pn_text_json_str(text, pn_cell.between[i]);
    }
    pn_text_char(text, ']');
    member(text, "inputs");
    pn_text_char(text, '[');
    for (uint32_t i = 0U; i < pn_cell.input_count; i++) {
        const pn_cell_input_t *const own = &pn_cell.input[i];
        between(text, i);
        pn_text_char(text, '{');
        text_member(text, "name", own->name);
        text_member(text, "file", own->file);
        int_member(text, "place", (int64_t)own->place);
        text_member(text, "place_name", own->place_name);
        scalars_member(text, own->scalar, own->scalar_count);
        pn_text_char(text, '}');
    }
    pn_text_char(text, ']');
    member(text, "peers");
    pn_text_char(text, '[');
    for (uint32_t i = 0U; i < pn_cell.peer_count; i++) {
        between(text, i);
        pn_text_char(text, '{');
        text_member(text, "name", pn_cell.peer[i].name);
        int_member(text, "owner", pn_cell.peer[i].owner);
        pn_text_char(text, '}');
    }
    pn_text_char(text, ']');
    member(text, "final");
    pn_text_char(text, '[');
    for (uint32_t i = 0U; i < pn_cell.final_count; i++) {
        between(text, i);
        pn_text_uint(text, pn_cell.final_place[i]);
    }
    pn_text_char(text, ']');
}

static void net_tables(pn_text_t *text)
{
    text_member(text, "name", pn_net.name);
    text_member(text, "source", pn_net.source);
    text_member(text, "digest", pn_net.digest);
    bool_member(text, "timed", pn_net.timed);
    bool_member(text, "real_time", pn_net.real_time);
    member(text, "owners");
    pn_text_char(text, '[');
    for (uint32_t i = 0U; i < pn_net.owner_count; i++) {
        between(text, i);
        pn_text_json_str(text, pn_net.owner[i].name);
    }
    pn_text_char(text, ']');
    member(text, "order");
    pn_text_char(text, '[');
    for (uint32_t i = 0U; i < pn_net.order_count; i++) {
        between(text, i);
        pn_text_uint(text, pn_net.order[i]);
    }
    pn_text_char(text, ']');
    member(text, "places");
    pn_text_char(text, '[');
    for (uint32_t i = 0U; i < pn_net.place_count; i++) {
        const pn_place_t *const own = &pn_net.place[i];
        between(text, i);
        pn_text_char(text, '{');
        text_member(text, "name", own->name);
        text_member(text, "colset", own->colset);
        int_member(text, "owner", own->owner);
        bool_member(text, "timed", own->bag->is_timed);
        int_member(text, "bound", own->is_bounded ? (int64_t)own->bound : -1);
        pn_text_char(text, '}');
    }
    pn_text_char(text, ']');
    member(text, "transitions");
    pn_text_char(text, '[');
    for (uint32_t i = 0U; i < pn_net.transition_count; i++) {
        const pn_transition_t *const own = &pn_net.transition[i];
        between(text, i);
        pn_text_char(text, '{');
        text_member(text, "name", own->name);
        text_member(text, "id", own->id);
        int_member(text, "owner", own->owner);
        int_member(text, "priority", own->priority);
        pn_text_char(text, '}');
    }
    pn_text_char(text, ']');
}

void conform_tables(pn_text_t *text)
{
    pn_text_str(text, "{\"cell\": {");
    cell_tables(text);
    pn_text_str(text, "}, \"net\": {");
    net_tables(text);
    pn_text_str(text, "}}");
}
