/* SPDX-License-Identifier: MIT
 * supervisor_alone.c - the whole net in memory, without files: `--dry-run`, and nets that have no cell.
 *
 * Every owner plays the scheme of docs/execution.md in turn (priorities count within an owner, as in the cell),
 * messages are tokens in the channels' places and arrive at once. When nothing is enabled, model time jumps to the next
 * time stamp.
 *
 * An owner that repeats itself (it asks a sensor again and again, which has one value in a dry run) gives way to the
 * others, always in the same marking of those that it goes through. Where nobody else can do anything, the cell is
 * taken to be at rest.
 */
#include "supervisor_impl.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "pn/pn_port.h"

#define PATIENCE   100U /* firings of a turn before anybody looks whether it repeats itself: chance may end it */
#define LOOP_NAMED 8U   /* firings of a repetition that are named */

/* Whether the owner that plays comes to markings where it has been in this turn (Brent's algorithm). */
typedef struct repetition {
    uint64_t fired;  /* in this turn */
    uint64_t kept;   /* hash of the marking after firing number `since` */
    uint64_t since;  /* 0: none is kept */
    uint64_t least;  /* of the hashes since then: the marking in which the owner gives way */
    bool is_certain; /* it does repeat itself, and `least` is that of the whole loop */
} repetition_t;

static uint64_t s_given_way[PN_CELL_PEERS_MAX + 1U]; /* the marking in which each owner gave way last, 0: none */
static int32_t s_repeats = -1; /* an owner that has given way since somebody else has done something */

static bool s_occupied[PN_CELL_CHANNELS_MAX]; /* channels that held a token when last looked at */

/* Whether the token of a channel can be written. */
static bool is_sendable(const sup_t *sup, const pn_cell_channel_t *channel)
{
    static char text[PN_CHANNEL_TEXT];
    pn_scalar_value_t scalar_value[PN_CHANNEL_SCALARS];
    const uint32_t count =
        pn_multiset_token(sup->net->place[channel->place].multiset, sup->marking, 0U, scalar_value, PN_CHANNEL_SCALARS);
    return (count > 0U) && (pn_channel_compose(channel, scalar_value, 1U, "00000000", text, sizeof text) > 0U);
}

/* After a firing: prints messages that appeared, and watches that no channel holds two and that each can be written. */
static bool note_messages(sup_t *sup)
{
    for (uint32_t i = 0U; i < sup->cell->channel_count; i++) {
        const pn_cell_channel_t *const channel = &sup->cell->channel[i];
        const uint64_t tokens = pn_multiset_total(sup->net->place[channel->place].multiset, sup->marking);
        const char *const peer = sup->cell->peer[channel->peer].name;
        if (tokens > 1U) {
            return sup_stop(sup, SUP_EXIT_MODEL,
                            "channel-overrun: place `%s` holds %" PRIu64 " messages; %s can hold one",
                            channel->place_name, tokens, channel->file);
        }
        if ((tokens == 1U) && !s_occupied[i]) {
            char text[PN_CHANNEL_TEXT];
            const bool out = (channel->direction == PN_CHANNEL_OUT);
            if (!is_sendable(sup, channel)) {
                return sup_stop(sup, SUP_EXIT_MODEL,
                                "the token of place `%s` cannot be written to %s: a value is not finite, out of its "
                                "range or too large, or "
                                "the message has more than %u bytes",
                                channel->place_name, channel->file, PN_CHANNEL_PAYLOAD);
            }
            (void)sup_token_text(sup, channel, text, sizeof text);
            sup_say(sup, 1, "%10.3f s  %s -> %s  %s: %s", sup->t, out ? sup->cell->side : peer,
                    out ? peer : sup->cell->side, channel->file, text);
        }
        s_occupied[i] = (tokens > 0U);
    }
    return true;
}

/* Of all bytes, never 0. A repetition that is seen where there is none only makes an owner give way. */
static uint64_t marking_hash(const sup_t *sup)
{
    const unsigned char *const bytes = sup->marking;
    const size_t size = sup->net->marking_size;
    uint64_t hash = 14695981039346656037U;
    for (size_t at = 0U; at < size; at += sizeof(uint64_t)) {
        uint64_t word = 0U;
        const size_t left = size - at;
        (void)memcpy(&word, &bytes[at], (left < sizeof word) ? left : sizeof word);
        hash = (hash ^ word) * 1099511628211U;
        hash ^= hash >> 29U;
    }
    return (hash != 0U) ? hash : 1U;
}

/* After a firing: whether the owner gives way. */
static bool gives_way(const sup_t *sup, repetition_t *loop)
{
    loop->fired++;
    if (loop->fired < PATIENCE) {
        return false;
    }
    const uint64_t hash = marking_hash(sup);
    if (loop->is_certain && (loop->fired < (2U * loop->since))) {
        return hash == loop->least;
    }
    loop->is_certain = false; /* or chance has ended it */
    loop->least = (hash < loop->least) ? hash : loop->least;
    if (hash == loop->kept) {
        loop->is_certain = true;
        return hash == loop->least;
    }
    if ((loop->since == 0U) || (loop->fired >= (2U * loop->since))) {
        loop->kept = hash;
        loop->since = loop->fired;
        loop->least = hash;
    }
    return false;
}

/* One owner until it comes to rest, or gives way. Counts its firings, if they have led to something new. */
static bool play_owner(sup_t *sup, int32_t owner, uint64_t *count)
{
    repetition_t loop = { 0U, 0U, 0U, 0U, false };
    uint32_t transition = 0U;
    int result = 1;
    while (result > 0) {
        if (pn_port_stop_signal() != 0) {
            return sup_stop(sup, SUP_EXIT_INTERRUPTED, "interrupted by signal %d", pn_port_stop_signal());
        }
        if (sup->fired >= sup->options.max_firings) {
            return true;
        }
        result = sup_fire_one(sup, owner, &transition);
        if ((result > 0) && !note_messages(sup)) {
            result = -1;
        }
        if ((result > 0) && (owner >= 0) && gives_way(sup, &loop)) {
            s_repeats = owner;
            if (s_given_way[owner] != loop.least) {
                s_given_way[owner] = loop.least;
                *count += loop.fired;
            }
            return true;
        }
    }
    *count += loop.fired;
    return result == 0;
}

/* Every owner in turn, until none can do anything but repeat itself. */
static bool play_all(sup_t *sup)
{
    const bool is_whole = (sup->cell->owner < 0) || (sup->net->owner_count > (PN_CELL_PEERS_MAX + 1U));
    const uint32_t parties = is_whole ? 1U : sup->net->owner_count;
    uint64_t count = 1U;
    while (count > 0U) {
        count = 0U;
        s_repeats = -1;
        for (uint32_t i = 0U; i < parties; i++) {
            if (!play_owner(sup, (parties == 1U) ? -1 : (int32_t)i, &count)) {
                return false;
            }
        }
        if (sup->fired >= sup->options.max_firings) {
            return true;
        }
    }
    return true;
}

/* Stops where an owner repeats itself and nobody else can do anything: with what it does. */
static void stop_repetition(sup_t *sup)
{
    char told[640];
    pn_text_t text;
    const uint64_t begin = marking_hash(sup);
    bool goes_on = true;
    pn_text_init(&text, told, sizeof told);
    for (uint32_t k = 0U; goes_on && (k < LOOP_NAMED); k++) {
        uint32_t transition = 0U;
        char binding[128];
        pn_text_t json;
        goes_on = (sup_fire_one(sup, s_repeats, &transition) > 0);
        if (goes_on) {
            pn_text_init(&json, binding, sizeof binding);
            pn_json(sup->net->transition[transition].binding, sup->binding, &json);
            pn_text_str(&text, (k > 0U) ? ", `" : "`");
            pn_text_str(&text, sup->net->transition[transition].name);
            pn_text_str(&text, "` ");
            pn_text_str(&text, json.truncated ? "" : binding);
            goes_on = (marking_hash(sup) != begin);
        }
    }
    (void)sup_stop(sup, SUP_EXIT_MODEL,
                   "no end in a final place (`%s`%s): nobody but %s can do anything, and it repeats itself for ever: "
                   "%s%s; sensors have their first values in a dry run",
                   sup->net->place[sup->cell->final_place[0]].name, (sup->cell->final_count > 1U) ? ", ..." : "",
                   sup->net->owner[s_repeats].name, told, goes_on ? ", ..." : "");
}

static void print_summary(const sup_t *sup)
{
    sup_say(sup, 1, "fired %" PRIu64 " transitions:", sup->fired);
    for (uint32_t i = 0U; i < sup->net->transition_count; i++) {
        if (sup->fired_of[i] > 0U) {
            sup_say(sup, 1, "  %s  %" PRIu64, sup->net->transition[i].name, sup->fired_of[i]);
        }
    }
    sup_trace_marking(sup);
}

/* Until `t` seconds have passed. False when the program has to stop. */
static bool wait_until(sup_t *sup, uint64_t begin, double t)
{
    double left = t - ((double)(pn_port_now() - begin) * 1e-9);
    while ((left > 0.0) && (pn_port_stop_signal() == 0)) {
        (void)pn_port_wait(-1, (uint64_t)(((left < 1.0) ? left : 1.0) * 1e9) + 1U);
        left = t - ((double)(pn_port_now() - begin) * 1e-9);
    }
    if (pn_port_stop_signal() != 0) {
        return sup_stop(sup, SUP_EXIT_INTERRUPTED, "interrupted by signal %d", pn_port_stop_signal());
    }
    return true;
}

/* After as many firings as are allowed: whether anything is enabled still, which is said; true after an error, too. */
static bool goes_beyond(sup_t *sup)
{
    uint32_t transition = 0U;
    const bool is_spent = (sup->fired >= sup->options.max_firings);
    const int found = is_spent ? sup_find_one(sup, -1, &transition) : 0;
    if (found > 0) {
        if (sup->cell->owner >= 0) {
            (void)sup_stop(sup, SUP_EXIT_MODEL, "no end after %" PRIu64 " firings (--max-firings N allows more)",
                           sup->fired);
        } else { /* no mistake: a net may go on for ever; but its trace must not say that it has finished */
            (void)snprintf(sup->reason, sizeof sup->reason, "no end after %" PRIu64 " firings", sup->fired);
            sup_say(sup, 1,
                    "stopped after %" PRIu64 " firings, transitions are still enabled (--max-firings N allows more)",
                    sup->fired);
        }
    }
    return found != 0;
}

void sup_run_alone(sup_t *sup)
{
    const uint64_t begin = pn_port_now();
    bool on = note_messages(sup); /* and which channels are occupied */
    while (on) {
        double next = 0.0;
        on = play_all(sup);
        if (on && goes_beyond(sup)) {
            on = false;
        } else if (on && !sup_is_final(sup) && sup_next_time(sup, &next)) {
            on = !sup->options.paced || wait_until(sup, begin, next);
            sup->t = next;
            sup_set_time(sup, next);
        } else {
            on = false;
        }
    }
    if (!sup->stopped && (sup->cell->final_count > 0U) && !sup_is_final(sup)) {
        if (s_repeats >= 0) {
            stop_repetition(sup);
        }
        print_summary(sup);
        (void)sup_stop(sup, SUP_EXIT_MODEL, "deadlock: nothing is enabled, and no final place (`%s`%s) holds a token",
                       sup->net->place[sup->cell->final_place[0]].name, (sup->cell->final_count > 1U) ? ", ..." : "");
    } else {
        print_summary(sup);
    }
}
