/* SPDX-License-Identifier: MIT
 * supervisor_cell.c - the cycle of docs/execution.md over a transport: read, fire, publish, wait. In real time or in
 * lock-step. I1..I10 are the invariants of docs/protocol.md.
 */
#include "supervisor_impl.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "pn/pn_port.h"

#ifndef SUP_GRACE_S
#define SUP_GRACE_S 0.5 /* tests have more */
#endif
static const double GRACE_S = SUP_GRACE_S; /* I6: how long a refused file may stay as it is */
static const double LOOK_S = 0.1;          /* I8: how often the peers are looked at */

static const uint32_t GONE_LOOKS = 6U; /* a status file that says nothing may do so for GRACE_S: five looks */

/* What the host knows of a channel. */
typedef struct channel_state {
    bool pending; /* in: its message is a token that has not been consumed */
    bool refused;
    double refused_since; /* wall time, s */
    uint32_t reported;    /* checksum of the report that was printed last */
    char report[PN_CHANNEL_REPORT];
} channel_state_t;

typedef struct peer_state {
    bool owes;            /* a flag was written to it, and nothing has come back since */
    double due;           /* s, on the cell's clock (wall time, or lock-step's): if it owes, late after that */
    const char *owes_for; /* the flag's file */
    bool idle_end;        /* it has finished although it owes, seen once: its last message may still be on its way */
    uint32_t looks;       /* 0: it has not announced itself yet; 1: it has; above: so often in vain since */
} peer_state_t;

static struct {
    pn_transport_t transport;
    pn_message_t message;
    uint64_t begin; /* pn_port_now() at the start */
    double looked;  /* when the peers were looked at last */
    bool all_ended; /* all peers have finished, seen once */
    uint64_t sent, received;
    uint64_t most_fired; /* in one cycle */
    channel_state_t channel[PN_CELL_CHANNELS_MAX];
    peer_state_t peer[PN_CELL_PEERS_MAX];
} s_cell;

static double wall_time(void)
{
    const uint64_t passed = pn_port_now() - s_cell.begin;
    return (double)passed * 1e-9;
}

static bool stop_for_transport(sup_t *sup)
{
    const pn_transport_fault_t *const fault = s_cell.transport.fault;
    return sup_stop(sup, fault->io ? SUP_EXIT_IO : SUP_EXIT_CHANNEL, "%s", fault->text);
}

/* --- step 1: read ------------------------------------------------------------------------------------------------- */

/* Notes a refusal, reports it once, and stops when it has lasted (I6). */
static bool refuse(sup_t *sup, uint32_t index)
{
    const pn_cell_channel_t *const channel = &sup->cell->channel[index];
    channel_state_t *const state = &s_cell.channel[index];
    const pn_message_t *const message = &s_cell.message;
    const uint32_t digest = pn_crc32(0U, message->report, strlen(message->report));
    if (!state->refused) {
        state->refused = true;
        state->refused_since = wall_time();
    }
    (void)snprintf(state->report, sizeof state->report, "%s", message->report);
    if (state->reported != digest) {
        state->reported = digest;
        sup_warn("%s: message of %s refused: %s", channel->file, sup->cell->peer[channel->peer].name, message->report);
    }
    if (message->refusal == PN_REFUSAL_OVERWRITTEN) { /* what was there cannot come back */
        return sup_stop(sup, SUP_EXIT_CHANNEL, "%s: %s", channel->file, message->report);
    }
    return true;
}

static bool accept_message(sup_t *sup, uint32_t index)
{
    const pn_cell_channel_t *const channel = &sup->cell->channel[index];
    const pn_place_t *const place = &sup->net->place[channel->place];
    channel_state_t *const state = &s_cell.channel[index];
    pn_message_t *const message = &s_cell.message;
    if (!pn_marking_put(sup->net, &sup->cx, sup->marking, channel->place, message->value, message->count)) {
        char text[PN_CHANNEL_TEXT];
        if (sup->cx.error != PN_ERR_COLOUR) {
            return sup_stop_error(sup, "putting the token of a message");
        }
        sup->cx.error = PN_OK;
        if (pn_scalars_format(channel->scalar, channel->scalar_count, message->value, text, sizeof text) == 0U) {
            text[0] = '\0';
        }
        message->refusal = PN_REFUSAL_COLOUR;
        (void)snprintf(message->report, sizeof message->report, "`%.200s` is not in the colour set `%s`", text,
                       place->colset);
        return refuse(sup, index);
    }
    s_cell.transport.accept(s_cell.transport.self, index);
    state->pending = true;
    state->refused = false;
    s_cell.peer[channel->peer].owes = false;
    s_cell.received++;
    if (sup->options.verbosity >= 2) {
        char text[PN_CHANNEL_TEXT];
        sup_say(sup, 2, "%10.3f s  %s: %s", sup->t, channel->file, sup_token_text(sup, channel, text, sizeof text));
    }
    return true;
}

static bool read_channel(sup_t *sup, uint32_t i)
{
    channel_state_t *const state = &s_cell.channel[i];
    bool good = true;
    switch (s_cell.transport.read(s_cell.transport.self, i, &s_cell.message)) {
    case PN_CHANNEL_UNCHANGED: break;
    case PN_CHANNEL_EMPTY: state->refused = false; break;
    case PN_CHANNEL_MESSAGE: good = accept_message(sup, i); break;
    case PN_CHANNEL_REFUSED: good = refuse(sup, i); break;
    case PN_CHANNEL_BROKEN:
    default: good = stop_for_transport(sup); break;
    }
    if (good && state->refused && (sup->options.lockstep || (wall_time() - state->refused_since >= GRACE_S))) {
        good = sup_stop(sup, SUP_EXIT_CHANNEL, "%s: message of %s refused: %s", sup->cell->channel[i].file,
                        sup->cell->peer[sup->cell->channel[i].peer].name, state->report);
    }
    return good;
}

/* Flags before data: what is published before a flag is there once the flag has been seen (I5). The other way round a
 * flag could be taken whose data came between the two looks. */
static bool read_channels(sup_t *sup)
{
    for (uint32_t pass = 0U; pass < 2U; pass++) {
        const pn_channel_kind_t kind = (pass == 0U) ? PN_CHANNEL_FLAG : PN_CHANNEL_DATA;
        for (uint32_t i = 0U; i < sup->cell->channel_count; i++) {
            const pn_cell_channel_t *const channel = &sup->cell->channel[i];
            if ((channel->direction == PN_CHANNEL_IN) && (channel->kind == kind) && !read_channel(sup, i)) {
                return false;
            }
        }
    }
    return true;
}

/* --- step 3: publish ---------------------------------------------------------------------------------------------- */

/* Empties the channels whose tokens have been consumed (I4). */
static bool clear_consumed(sup_t *sup)
{
    for (uint32_t i = 0U; i < sup->cell->channel_count; i++) {
        channel_state_t *const state = &s_cell.channel[i];
        if (state->pending
            && (pn_multiset_total(sup->net->place[sup->cell->channel[i].place].multiset, sup->marking) == 0U)) {
            state->pending = false;
            if (!s_cell.transport.clear(s_cell.transport.self, i)) {
                return stop_for_transport(sup);
            }
        }
    }
    return true;
}

static bool publish_token(sup_t *sup, uint32_t index)
{
    pn_scalar_value_t scalar_value[PN_CHANNEL_SCALARS];
    const pn_cell_channel_t *const channel = &sup->cell->channel[index];
    const pn_place_t *const place = &sup->net->place[channel->place];
    peer_state_t *const peer = &s_cell.peer[channel->peer];
    const uint64_t tokens = pn_multiset_total(place->multiset, sup->marking);
    if (tokens == 0U) {
        return true;
    }
    if (tokens > 1U) { /* I3 */
        return sup_stop(sup, SUP_EXIT_CHANNEL,
                        "channel-overrun: %" PRIu64 " messages for %s in one cycle; it can hold one", tokens,
                        channel->file);
    }
    if (pn_multiset_token(place->multiset, sup->marking, 0U, scalar_value, PN_CHANNEL_SCALARS) == 0U) {
        return sup_stop(sup, SUP_EXIT_CHANNEL,
                        "the token of place `%s` cannot be written to %s: an integer in it does not fit into 64 "
                        "bits, or it has more than %u values",
                        place->name, channel->file, PN_CHANNEL_SCALARS);
    }
    if (!s_cell.transport.write(s_cell.transport.self, index, scalar_value)) {
        return stop_for_transport(sup);
    }
    if (sup->options.verbosity >= 1) {
        char text[PN_CHANNEL_TEXT];
        sup_say(sup, 1, "%10.3f s  -> %s  %s: %s", sup->t, sup->cell->peer[channel->peer].name, channel->file,
                sup_token_text(sup, channel, text, sizeof text));
    }
    /* From here on the token lives in the file. Its writer has only output arcs on the place, so nothing can miss it
     * here. */
    pn_multiset_clear(place->multiset, sup->marking);
    s_cell.sent++;
    if ((channel->kind == PN_CHANNEL_FLAG) && !peer->owes) {
        peer->owes = true;
        peer->due = (sup->options.reply_timeout_s > 0.0) ? (sup->t + sup->options.reply_timeout_s) : (double)INFINITY;
        peer->owes_for = channel->file;
    }
    return true;
}

static bool publish(sup_t *sup)
{
    if (!clear_consumed(sup)) {
        return false;
    }
    for (uint32_t pass = 0U; pass < 2U; pass++) { /* I5 */
        const pn_channel_kind_t kind = (pass == 0U) ? PN_CHANNEL_DATA : PN_CHANNEL_FLAG;
        for (uint32_t i = 0U; i < sup->cell->channel_count; i++) {
            const pn_cell_channel_t *const channel = &sup->cell->channel[i];
            if ((channel->direction == PN_CHANNEL_OUT) && (channel->kind == kind) && !publish_token(sup, i)) {
                return false;
            }
        }
    }
    return true;
}

/* --- the cycle ---------------------------------------------------------------------------------------------------- */

/* One cycle at `t` seconds, or in real time. False when the program has to stop. */
static bool cycle(sup_t *sup, double t, uint64_t *fired)
{
    *fired = 0U;
    sup->t = (t > sup->t) ? t : sup->t;
    if (!read_channels(sup) || !sup_monitor_messages(sup, PN_CHANNEL_IN)) {
        return false;
    }
    if (!sup->options
             .lockstep) { /* a message that has been seen is not later than the time at which it is acted upon */
        sup->t = fmax(sup->t, wall_time());
    }
    sup_set_time(sup, sup->t);
    if (!sup_play(sup, sup->cell->owner, fired)) {
        return false; /* what was consumed stays in its file, what would be said is not said: I10 */
    }
    if (*fired > 0U) {
        s_cell.all_ended = false;
        s_cell.most_fired = (*fired > s_cell.most_fired) ? *fired : s_cell.most_fired;
    }
    if (!publish(sup) || !sup_monitor_messages(sup, PN_CHANNEL_OUT)) {
        return false;
    }
    return sup_trace_is_written(sup);
}

/* --- the peers (I8, I9) ------------------------------------------------------------------------------------------- */

static bool look_at_peer(sup_t *sup, uint32_t index, pn_party_t *party)
{
    const char *const name = sup->cell->peer[index].name;
    peer_state_t *const peer = &s_cell.peer[index];
    bool good = true;
    s_cell.transport.party(s_cell.transport.self, index, party);
    switch (party->state) {
    case PN_PARTY_STOPPED:
        good = sup_stop(sup, SUP_EXIT_PEER, "%s stopped: %s", name,
                        (party->reason[0] != '\0') ? party->reason : "it gave no reason");
        break;
    case PN_PARTY_DEAD: good = sup_stop(sup, SUP_EXIT_PEER, "%s (pid %" PRIu64 ") has died", name, party->pid); break;
    case PN_PARTY_FINISHED:
        if (peer->owes && peer->idle_end) {
            good = sup_stop(sup, SUP_EXIT_PEER, "%s has finished, but it owes an answer to %s", name, peer->owes_for);
        }
        peer->idle_end = peer->owes;
        break;
    case PN_PARTY_ABSENT:
        peer->looks += (peer->looks > 0U) ? 1U : 0U;
        if (peer->looks > (sup->options.lockstep ? 1U : GONE_LOOKS)) { /* nobody would notice that it dies */
            good = sup_stop(sup, SUP_EXIT_PEER, "the status file of %s has gone or cannot be understood", name);
        }
        break;
    case PN_PARTY_RUNNING:
    default: break;
    }
    peer->looks = (party->state == PN_PARTY_ABSENT) ? peer->looks : 1U;
    if (good && peer->owes && (sup->t > peer->due)) {
        good = sup_stop(
            sup, SUP_EXIT_PEER, "%s has not answered %s for %g s%s", name, peer->owes_for, sup->options.reply_timeout_s,
            (party->state == PN_PARTY_ABSENT) ? "; it has not announced itself at all: is it running?" : "");
    }
    return good;
}

static bool look_at_peers(sup_t *sup)
{
    uint32_t ended = 0U;
    for (uint32_t i = 0U; i < sup->cell->peer_count; i++) {
        pn_party_t party;
        if (!look_at_peer(sup, i, &party)) {
            return false;
        }
        ended += (party.state == PN_PARTY_FINISHED) ? 1U : 0U;
    }
    double next = 0.0;
    const bool is_timed = sup_next_time(sup, &next);
    if (sup->stopped) {
        return false;
    }
    const bool all = (ended == sup->cell->peer_count) && !is_timed;
    if (all && s_cell.all_ended && (sup->cell->final_count > 0U)) {
        return sup_stop(
            sup, SUP_EXIT_MODEL,
            "deadlock: all robots have finished, nothing is enabled, and no final place (`%s`%s) holds a token",
            sup->net->place[sup->cell->final_place[0]].name, (sup->cell->final_count > 1U) ? ", ..." : "");
    }
    s_cell.all_ended = all;
    return true;
}

/* --- real time ---------------------------------------------------------------------------------------------------- */

static bool interrupted(sup_t *sup)
{
    return sup_stop(sup, SUP_EXIT_INTERRUPTED, "interrupted by signal %d", pn_port_stop_signal());
}

/* How long nothing can happen but by a file that changes. False when the program has to stop. */
static bool time_to_wait(sup_t *sup, uint64_t *wait_ns)
{
    double wait = LOOK_S - (wall_time() - s_cell.looked);
    double next = 0.0;
    if (sup_next_time(sup, &next)) {
        wait = fmin(wait, next - wall_time());
    }
    *wait_ns = (wait > 0.0) ? (uint64_t)(wait * 1e9) + 1U : 0U;
    return !sup->stopped;
}

static void run_real_time(sup_t *sup)
{
    bool on = true;
    while (on) {
        uint64_t fired = 0U;
        uint64_t wait_ns = 0U;
        on = cycle(sup, wall_time(), &fired);
        if (on && sup_is_final(sup)) {
            return;
        }
        if (on && (wall_time() - s_cell.looked >= LOOK_S)) {
            s_cell.looked = wall_time();
            on = look_at_peers(sup);
        }
        on = on && time_to_wait(sup, &wait_ns);
        if (on) {
            (void)fflush(stdout); /* progress is worth seeing, but not worth delaying an answer */
            if (s_cell.transport.wait(s_cell.transport.self, wait_ns) == PN_WAIT_SIGNAL) {
                on = interrupted(sup);
            }
        }
    }
}

/* --- lock-step ---------------------------------------------------------------------------------------------------- */

static void answer(const char *text)
{
    (void)fputs(text, stdout);
    (void)fputc('\n', stdout);
    (void)fflush(stdout);
}

/* The last answer, if it has not finished. */
static void answer_stopped(const sup_t *sup)
{
    if (sup->options.lockstep && sup->stopped) {
        char text[sizeof sup->reason + 16U];
        (void)snprintf(text, sizeof text, "stopped %s", sup->reason);
        answer(text);
    }
}

/* Takes one line from standard input. False at its end or when interrupted. */
static bool command_line(char *line, size_t capacity)
{
    static char buffer[4096];
    static size_t have = 0U;
    const char *end = memchr(buffer, '\n', have);
    while (end == NULL) {
        if (have == sizeof buffer) {
            have = 0U; /* nobody sends such a line: it is answered as unknown */
        }
        if (pn_port_stop_signal() != 0) {
            return false;
        }
        if (pn_port_wait(0, UINT64_MAX)) {
            const long got = pn_port_receive(0, buffer + have, sizeof buffer - have);
            if (got == 0) {
                return false;
            }
            have += (got > 0) ? (size_t)got : 0U;
        }
        end = memchr(buffer, '\n', have);
    }
    const ptrdiff_t distance = end - buffer;
    const size_t length = (size_t)distance;
    const size_t kept = (length < capacity) ? length : capacity - 1U;
    (void)memcpy(line, buffer, kept);
    line[kept] = '\0';
    have -= length + 1U;
    (void)memmove(buffer, buffer + length + 1U, have);
    return true;
}

static bool step_command(sup_t *sup, double t, bool *finished)
{
    uint64_t fired = 0U;
    char text[160];
    char when[PN_REAL_TEXT_SIZE];
    double next = 0.0;
    double due = (double)INFINITY;
    (void)memcpy(when, "-", sizeof "-");
    if (!look_at_peers(sup) || !cycle(sup, t, &fired)) {
        return false;
    }
    for (uint32_t i = 0U; i < sup->cell->peer_count; i++) {
        if (s_cell.peer[i].owes && (s_cell.peer[i].due < due)) {
            due = s_cell.peer[i].due;
        }
    }
    if (sup_next_time(sup, &next)) {
        pn_text_t number;
        pn_text_init(&number, when, sizeof when);
        pn_text_real(&number, next);
    }
    if (sup->stopped) {
        return false;
    }
    *finished = sup_is_final(sup);
    (void)snprintf(text, sizeof text, "idle %" PRIu64 " %s %s %.17g", fired, when, *finished ? "finished" : "running",
                   due);
    answer(text);
    return true;
}

static void run_lockstep(sup_t *sup)
{
    char line[1024];
    bool on = true;
    bool finished = false;
    while (on && !finished) {
        if (!command_line(line, sizeof line)) {
            on = (pn_port_stop_signal() != 0)
                     ? interrupted(sup)
                     : sup_stop(sup, SUP_EXIT_INTERRUPTED, "the engine has gone (end of input)");
        } else if (strncmp(line, "step ", 5U) == 0) {
            char *end = NULL;
            const double t = strtod(line + 5, &end);
            on = ((end != line + 5) && (*end == '\0') && isfinite(t))
                     ? step_command(sup, t, &finished)
                     : sup_stop(sup, SUP_EXIT_USAGE, "lock-step: `%s` has no time in seconds", line);
        } else if (strncmp(line, "stop", 4U) == 0) {
            on = sup_stop(sup, SUP_EXIT_PEER, "%s", (line[4] == ' ') ? line + 5 : "told to stop");
        } else {
            on = sup_stop(sup, SUP_EXIT_USAGE,
                          "lock-step: unknown command `%s`; there are `step SECONDS` and `stop REASON`", line);
        }
    }
}

/* --- start and end ------------------------------------------------------------------------------------------------ */

static void on_notice(void *user, const char *text)
{
    (void)user;
    sup_warn("%s", text);
}

void sup_run_cell(sup_t *sup)
{
    const pn_files_options_t options = {
        .directory = sup->options.directory,
        .create = true,
        .watch = !sup->options.lockstep && (sup->options.poll_ns == 0U),
        .poll_ns = (sup->options.poll_ns != 0U) ? sup->options.poll_ns : 2000000U,
        .notice = on_notice,
        .user = NULL,
    };
    sup_say(sup, 1, "shared directory %s", sup->options.directory);
    if (!pn_files_open(sup->cell, &options, &s_cell.transport)) {
        (void)((pn_port_stop_signal() != 0) ? interrupted(sup) : stop_for_transport(sup));
        answer_stopped(sup);
        return;
    }
    sup_say(sup, 1, "session %s, %s", pn_files_session(),
            options.watch ? "woken by the files" : "looking at the files");
    s_cell.begin = pn_port_now();
    if (sup->options.lockstep) {
        run_lockstep(sup);
    } else {
        run_real_time(sup);
    }
    /* I10: the status is the last thing that is said. */
    if (!s_cell.transport.announce(s_cell.transport.self, sup->stopped ? PN_PARTY_STOPPED : PN_PARTY_FINISHED,
                                   sup->reason)) {
        (void)stop_for_transport(sup);
    }
    s_cell.transport.close(s_cell.transport.self);
    answer_stopped(sup);
    static char places[4096];
    pn_text_t where;
    pn_text_init(&where, places, sizeof places);
    if (!sup->stopped) {
        pn_text_str(&where, " in ");
        sup_final_places(sup, &where);
    }
    sup_say(sup, 1,
            "%s after %.3f s%s: %" PRIu64 " firings (at most %" PRIu64 " in one cycle), %" PRIu64
            " messages sent, %" PRIu64 " received",
            sup->stopped ? "stopped" : "finished", sup->t, places, sup->fired, s_cell.most_fired, s_cell.sent,
            s_cell.received);
}
