/* SPDX-License-Identifier: MIT
 * supervisor_alone.c - the whole net in memory, without files: `--dry-run`, and nets that have no cell.
 *
 * Every owner plays the scheme of docs/execution.md in turn (priorities count within an owner, as in the cell),
 * messages are tokens in the channels' places and arrive at once. When nothing is enabled, model time jumps to the next
 * time stamp.
 */
#include "supervisor_impl.h"

#include <inttypes.h>
#include <stdio.h>

#include "pn/pn_port.h"

static bool s_occupied[PN_CELL_CHANNELS_MAX]; /* channels that held a token when last looked at */

/* Whether the token of a channel can be written. */
static bool is_sendable(const sup_t *sup, const pn_cell_channel_t *channel)
{
    static char text[PN_CHANNEL_TEXT];
    pn_leaf_t leaf[PN_CHANNEL_SCALARS];
    const uint32_t count =
        pn_bag_token(sup->net->place[channel->place].bag, sup->marking, 0U, leaf, PN_CHANNEL_SCALARS);
    return (count == channel->scalar_count)
           && (pn_channel_compose(channel, leaf, 1U, "00000000", text, sizeof text) > 0U);
}

/* After a firing: prints messages that appeared, and watches that no channel holds two and that each can be written. */
static bool note_messages(sup_t *sup)
{
    for (uint32_t i = 0U; i < sup->cell->channel_count; i++) {
        const pn_cell_channel_t *const channel = &sup->cell->channel[i];
        const uint64_t tokens = pn_bag_total(sup->net->place[channel->place].bag, sup->marking);
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

/* One owner until it comes to rest. */
static bool play_owner(sup_t *sup, int32_t owner, uint64_t *count)
{
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
        if (result > 0) {
            (*count)++;
            if (!note_messages(sup)) {
                result = -1;
            }
        }
    }
    return result == 0;
}

static bool play_all(sup_t *sup)
{
    const uint32_t parties = ((sup->cell->owner < 0) || (sup->net->owner_count == 0U)) ? 1U : sup->net->owner_count;
    uint64_t count = 1U;
    while (count > 0U) {
        count = 0U;
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

void sup_run_alone(sup_t *sup)
{
    const uint64_t begin = pn_port_now();
    const bool cut_is_error = (sup->cell->owner >= 0);
    bool on = note_messages(sup); /* and which channels are occupied */
    while (on) {
        double next = 0.0;
        on = play_all(sup);
        if (on && (sup->fired >= sup->options.max_firings)) {
            on = false;
            if (cut_is_error) {
                (void)sup_stop(sup, SUP_EXIT_MODEL, "no end after %" PRIu64 " firings (--max-firings N allows more)",
                               sup->fired);
            } else {
                sup_say(sup, 1,
                        "stopped after %" PRIu64
                        " firings, transitions are still enabled (--max-firings N allows more)",
                        sup->fired);
            }
        } else if (on && !sup_is_final(sup) && sup_next_time(sup, &next)) {
            while (sup->options.paced && on && ((double)(pn_port_now() - begin) * 1e-9 < next)) {
                const double left = next - ((double)(pn_port_now() - begin) * 1e-9);
                (void)pn_port_wait(-1, (uint64_t)(((left > 0.0) ? ((left < 1.0) ? left : 1.0) : 0.0) * 1e9) + 1U);
                on = (pn_port_stop_signal() == 0)
                     || sup_stop(sup, SUP_EXIT_INTERRUPTED, "interrupted by signal %d", pn_port_stop_signal());
            }
            sup->t = next;
            sup_set_time(sup, next);
        } else {
            on = false;
        }
    }
    if (!sup->stopped && (sup->cell->final_count > 0U) && !sup_is_final(sup)) {
        print_summary(sup);
        (void)sup_stop(sup, SUP_EXIT_MODEL, "deadlock: nothing is enabled, and no final place (`%s`%s) holds a token",
                       sup->net->place[sup->cell->final_place[0]].name, (sup->cell->final_count > 1U) ? ", ..." : "");
    } else {
        print_summary(sup);
    }
}
