/* SPDX-License-Identifier: MIT
 * odd_net.c - a pn_net written by hand that does what the net of a cell is proven not to do, or does seldom: the token
 * of Orders (an input file) says what. Tests see what the supervisor host makes of it.
 *
 *   Orders n --Odd--> ...             what `odd_fire` does for that n; 0: a token in Done, the end
 *   command --Robot.Do--> answer 1    the robot's only transition
 *   answer 1 --Finish--> Done
 *   Timer --Late--> Done              when its time has come
 *
 * Order 1000 + e raises the error e while it fires, 2000 + e while it is searched for, 900 one that says a value.
 * ODD_BEGIN=e in the environment raises it before anything of the net is evaluated. -DODD_REAL_TIME: the clock is
 * real. -DODD_OWNERS=N: so many. -DODD_TWICE: after the first answer something is said.
 */
#define _POSIX_C_SOURCE 200809L

#include <math.h>
#include <signal.h>
#include <stddef.h>
#include <stdlib.h>

#include "pn/pn_arena.h"
#include "pn/pn_multiset.h"
#include "pn/pn_big.h"
#include "pn/pn_marking.h"
#include "pn/pn_net.h"
#include "pn/pn_num.h"

#ifndef ODD_OWNERS
#define ODD_OWNERS 3U
#endif
#ifdef ODD_REAL_TIME
#define REAL_TIME true
#else
#define REAL_TIME false
#endif

enum {
    FINISH = 0,
    FINISH_TWICE = 1,   /* in both final places */
    COMMAND = 2,        /* one command; its answer ends the run */
    REST = 3,           /* nothing is enabled any more */
    TWO_MESSAGES = 4,   /* in one channel */
    NOT_FINITE = 5,     /* a message */
    TOO_MANY = 6,       /* tokens for a place's bound */
    SIGNAL = 7,         /* while it fires */
    BEYOND_64_BITS = 8, /* an integer of a message */
    MUCH_MEMORY = 9,
    NO_MEMORY = 10,   /* for what is collected */
    NO_TIME = 11,     /* looking for the next time raises an error */
    BAD_COMMAND = 12, /* out of its range */
    SHORT_LOOP = 13,
    LONG_LOOP = 14,
    WAIT = 15,         /* for a time stamp */
    LONG_TEXT = 16,    /* more than a message may have */
    TWO_COMMANDS = 17, /* the second one when Timer's time has come */
    NO_TIME_LATER = 18,
    DRAWN = 19,      /* the long loop, which something ends that is not in the marking */
    COUNT = 20,      /* up to 999, without ever repeating itself, to the end */
    LOOP_BEGIN = 50, /* 50 .. 52, 50 .. 62: the loops */
    COUNTED = 100,
    ILLEGAL = 900
};

/* A place for one token. */
#define PLACE_OF(value_t)    \
    struct {                 \
        uint32_t used;       \
        struct {             \
            value_t value;   \
            uint32_t count;  \
            pn_time_t stamp; \
        } token[1];          \
    }

typedef struct marking {
    pn_time_t now;
    PLACE_OF(int64_t) orders;
    PLACE_OF(pn_string_t) name;
    PLACE_OF(uint8_t) few;
    PLACE_OF(uint8_t) done;
    PLACE_OF(uint8_t) also;
    PLACE_OF(pn_string_t) say;
    PLACE_OF(pn_big_t) big;
    PLACE_OF(double) level;
    PLACE_OF(int64_t) command;
    PLACE_OF(pn_string_t) told;
    PLACE_OF(int64_t) answer;
    PLACE_OF(uint8_t) timer;
    PLACE_OF(int64_t) loop;
} marking_t;

typedef struct binding {
    int64_t n;
} binding_t;

/* --- colour sets -------------------------------------------------------------------------------------------------- */

static bool is_no_refusal(pn_ctx_t *cx, const void *value)
{
    (void)cx;
    const pn_string_t *const text = value;
    return (text->length == 0U) || (text->bytes[0] != '!');
}

static const pn_type_t UNIT = { .kind = PN_KIND_UNIT, .name = "UNIT", .size = sizeof(uint8_t) };
static const pn_type_t REAL = { .kind = PN_KIND_REAL, .name = "REAL", .size = sizeof(double) };
static const pn_type_t INT = { .kind = PN_KIND_INT, .name = "INT", .size = sizeof(int64_t) };
static const pn_type_t BIG = { .kind = PN_KIND_BIG, .name = "INTINF", .size = sizeof(pn_big_t) };
static const pn_type_t TEXT = { .kind = PN_KIND_STRING, .name = "TEXT", .size = sizeof(pn_string_t) };
static const pn_type_t TOLD = { .kind = PN_KIND_STRING,
                                .name = "TOLD",
                                .size = sizeof(pn_string_t),
                                .member = is_no_refusal };
static const pn_field_t BINDING_FIELD[] = { { "n", &INT, offsetof(binding_t, n), false } };
static const pn_type_t BINDING = { .kind = PN_KIND_RECORD,
                                   .name = "binding",
                                   .size = sizeof(binding_t),
                                   .count = 1U,
                                   .field = BINDING_FIELD };

/* --- places ------------------------------------------------------------------------------------------------------- */

#define MULTISET(field, value_type, timed)                                                      \
    static const pn_multiset_t field##_multiset = { .origin = "page `Odd`, place `" #field "`", \
                                                    .type = &(value_type),                      \
                                                    .capacity = 1U,                             \
                                                    .is_timed = (timed),                        \
                                                    .is_real_time = REAL_TIME,                  \
                                                    PN_MULTISET_STAMPS(marking_t, field) };

MULTISET(orders, INT, false)
MULTISET(name, TOLD, false)
MULTISET(few, UNIT, false)
MULTISET(done, UNIT, false)
MULTISET(also, UNIT, false)
MULTISET(say, TEXT, false)
MULTISET(big, BIG, false)
MULTISET(level, REAL, false)
MULTISET(command, INT, false)
MULTISET(told, TOLD, false)
MULTISET(answer, INT, false)
MULTISET(timer, UNIT, true)
MULTISET(loop, INT, false)

#define PUT(field, token_value, how_often)       \
    do {                                         \
        m->field.used = 1U;                      \
        m->field.token[0].value = (token_value); \
        m->field.token[0].count = (how_often);   \
    } while (false)
#define TAKE(field)  (m->field.used = 0U)
#define HAS(field)   (m->field.used > 0U)
#define VALUE(field) (m->field.token[0].value)

static bool begin(pn_ctx_t *cx, void *marking)
{
    marking_t *const m = marking;
    (void)cx;
    PUT(orders, FINISH, 1U);
    return true;
}

static void set_up(pn_ctx_t *cx)
{
    const char *const error = getenv("ODD_BEGIN");
    if (error != NULL) {
        pn_raise(cx, (pn_error_t)strtol(error, NULL, 10), NULL);
    }
}

#define PLACE_ROW(field, place_name, place_owner) \
    .name = (place_name), .colset = "ODD", .owner = (place_owner), .multiset = &field##_multiset

static const pn_place_t PLACE[] = {
    { PLACE_ROW(orders, "Odd.Orders", 0), .initial = begin },
    { PLACE_ROW(name, "Odd.Name", 0) },
    { PLACE_ROW(few, "Odd.Few", 0), .is_bounded = true, .bound = 1U },
    { PLACE_ROW(done, "Odd.Done", 0) },
    { PLACE_ROW(also, "Odd.Also", 0) },
    { PLACE_ROW(say, "Odd.say", -1) },
    { PLACE_ROW(big, "Odd.big", -1) },
    { PLACE_ROW(level, "Odd.level", -1) },
    { PLACE_ROW(command, "Odd.command", -1), .is_bounded = true, .bound = 1U },
    { PLACE_ROW(told, "Odd.told", -1) },
    { PLACE_ROW(answer, "Odd.answer", -1) },
    { PLACE_ROW(timer, "Odd.Timer", 0) },
    { PLACE_ROW(loop, "Odd.Loop", 0), .is_bounded = true, .bound = 1U },
};

/* --- transitions -------------------------------------------------------------------------------------------------- */

static bool offer(const marking_t *m, bool enabled, uint32_t self, pn_binding_sink_t sink, void *user)
{
    const binding_t binding = { HAS(orders) ? VALUE(orders) : VALUE(loop) };
    return !enabled || sink(user, self, &binding);
}

#define ENUMERATE(transition, condition)                                                                         \
    static bool transition##_enumerate(pn_ctx_t *cx, const void *marking, uint32_t self, pn_binding_sink_t sink, \
                                       void *user)                                                               \
    {                                                                                                            \
        const marking_t *const m = marking;                                                                      \
        pn_begin(cx, "page `Odd`, transition `" #transition "` (ID7)", m->now);                                  \
        if (HAS(orders) && (VALUE(orders) >= 2000)) {                                                            \
            pn_raise(cx, (pn_error_t)(VALUE(orders) - 2000), NULL);                                              \
        }                                                                                                        \
        return offer(m, pn_ok(cx) && (condition), self, sink, user);                                             \
    }

static bool is_late(const marking_t *m)
{
    const pn_time_t stamp = m->timer.token[0].stamp;
    return HAS(timer) && (REAL_TIME ? (stamp.real <= m->now.real) : (stamp.integer <= m->now.integer));
}

ENUMERATE(odd, HAS(orders) && (VALUE(orders) != REST) && (VALUE(orders) != NO_TIME))
ENUMERATE(finish, HAS(answer) && (VALUE(answer) == 1))
ENUMERATE(late, is_late(m))
ENUMERATE(turn, HAS(loop))
ENUMERATE(work, HAS(command))

static pn_string_t long_text(pn_ctx_t *cx)
{
    enum { LENGTH = 4060 };
    char *const bytes = pn_arena_alloc(cx, LENGTH + 1U);
    if (bytes == NULL) {
        return (pn_string_t){ "", 0U };
    }
    (void)memset(bytes, 'x', LENGTH);
    bytes[LENGTH] = '\0';
    return (pn_string_t){ bytes, LENGTH };
}

static void send_odd(pn_ctx_t *cx, marking_t *m, int64_t n)
{
    static const char two_to_64[] = "\6\0\0\0\0\0\0\0\0\0\0\0\1\0\0\0";
    switch (n) {
    case COMMAND:
    case TWO_COMMANDS: PUT(command, 1, 1U); break;
    case TWO_MESSAGES: PUT(command, 1, 2U); break;
    case NOT_FINITE: PUT(level, (double)NAN, 1U); break;
    case BEYOND_64_BITS: PUT(big, PN_BIG_BYTES(two_to_64), 1U); break;
    case BAD_COMMAND: PUT(command, 101, 1U); break;
    case LONG_TEXT: PUT(say, long_text(cx), 1U); break;
    default: break;
    }
}

static int64_t s_left = -1; /* turns until chance ends the loop; -1: it never does */

static void odd_more(pn_ctx_t *cx, marking_t *m, int64_t n)
{
    const pn_time_t later = { .integer = m->now.integer + 1000 };
    const pn_time_t later_real = { .real = m->now.real + 1000.0 };
    switch (n) {
    case FINISH_TWICE:
        PUT(also, 0U, 1U);
        PUT(done, 0U, 1U);
        break;
    case TOO_MANY: PUT(few, 0U, 2U); break;
    case SIGNAL:
        (void)raise(SIGTERM);
        PUT(done, 0U, 1U);
        break;
    case MUCH_MEMORY:
    case NO_MEMORY:
        (void)pn_arena_alloc(cx, (cx->arena->half / 4U) * 3U);
        PUT(orders, (n == NO_MEMORY) ? NO_MEMORY : FINISH, 1U);
        break;
    case SHORT_LOOP:
    case LONG_LOOP:
    case DRAWN:
        s_left = (n == DRAWN) ? 121 : -1;
        PUT(loop, (n == SHORT_LOOP) ? LOOP_BEGIN : (LOOP_BEGIN + 10) + ((n == DRAWN) ? 5 : 0), 1U);
        break;
    case NO_TIME_LATER: PUT(orders, NO_TIME, 1U); break;
    case TWO_COMMANDS:
    case WAIT:
        if (n == TWO_COMMANDS) {
            PUT(few, 0U, 1U);
        }
        PUT(timer, 0U, 1U);
        m->timer.token[0].stamp = REAL_TIME ? later_real : later;
        break;
    case COUNT: PUT(loop, COUNTED, 1U); break;
    default: break;
    }
}

static bool odd_fire(pn_ctx_t *cx, void *marking, uint32_t self, void *binding)
{
    marking_t *const m = marking;
    const int64_t n = ((const binding_t *)binding)->n;
    (void)self;
    pn_begin(cx, "page `Odd`, transition `odd` (ID7)", m->now);
    if (n == ILLEGAL) {
        pn_raise_colour(cx, &INT, &n);
        return false;
    }
    if (n >= 1000) {
        pn_raise(cx, (pn_error_t)(n - 1000), (n == (1000 + PN_ERR_RAISED)) ? "Own" : NULL);
        return false;
    }
    TAKE(orders);
    if (n == FINISH) {
        PUT(done, 0U, 1U);
    }
    send_odd(cx, m, n);
    odd_more(cx, m, n);
    return pn_ok(cx);
}

static bool finish_fire(pn_ctx_t *cx, void *marking, uint32_t self, void *binding)
{
    marking_t *const m = marking;
    (void)cx, (void)self, (void)binding;
    TAKE(answer);
#ifdef ODD_TWICE
    PUT(say, ((pn_string_t){ "thanks", 6U }), 1U);
#endif
    PUT(done, 0U, 1U);
    return true;
}

static bool late_fire(pn_ctx_t *cx, void *marking, uint32_t self, void *binding)
{
    marking_t *const m = marking;
    (void)cx, (void)self, (void)binding;
    TAKE(timer);
    if (HAS(few)) {
        TAKE(few);
        PUT(command, 2, 1U);
    } else {
        PUT(done, 0U, 1U);
    }
    return true;
}

/* 50, 51, 52, 50, ...; 60, 61, .. 79, 60, ...; 100, 101, .. 999 */
static bool turn_fire(pn_ctx_t *cx, void *marking, uint32_t self, void *binding)
{
    marking_t *const m = marking;
    s_left -= (s_left >= 0) ? 1 : 0;
    const int64_t next = (s_left == 0) ? COUNTED : (VALUE(loop) + 1);
    (void)cx, (void)self, (void)binding;
    if (next == 1000) {
        TAKE(loop);
        PUT(done, 0U, 1U);
    } else if (next == (LOOP_BEGIN + 3)) {
        PUT(loop, LOOP_BEGIN, 1U);
    } else if (next == (LOOP_BEGIN + 30)) {
        PUT(loop, LOOP_BEGIN + 10, 1U);
    } else {
        PUT(loop, next, 1U);
    }
    return true;
}

static bool work_fire(pn_ctx_t *cx, void *marking, uint32_t self, void *binding)
{
    marking_t *const m = marking;
    (void)cx, (void)self, (void)binding;
    TAKE(command);
    PUT(answer, 1, 1U);
    return true;
}

static const uint32_t TOUCHED[] = { 0U, 2U, 3U, 8U };
static const uint32_t TURNED[] = { 12U };

#define TRANSITION(fn, full, owned, changed)                 \
    { .name = (full),                                        \
      .id = "ID" #fn,                                        \
      .origin = "page `Odd`, transition `" full "`",         \
      .owner = (owned),                                      \
      .priority = 1000,                                      \
      .enumerate = fn##_enumerate,                           \
      .fire = fn##_fire,                                     \
      .touched_count = sizeof(changed) / sizeof(changed)[0], \
      .touched = (changed),                                  \
      .binding = &BINDING }

static const pn_transition_t TRANSITION_TABLE[] = {
    TRANSITION(odd, "Odd.Odd", 0, TOUCHED),       TRANSITION(finish, "Odd.Finish", 0, TOUCHED),
    TRANSITION(late, "Odd.Late", 0, TOUCHED),     TRANSITION(turn, "Odd.Turn", 0, TURNED),
    TRANSITION(work, "Odd.Robot.Do", 1, TOUCHED),
};

static const uint32_t ORDER[] = { 0U, 1U, 2U, 3U, 4U };
static const uint32_t MULTISETS[] = { 0U, 1U, 2U, 3U, 4U, 5U, 6U, 7U, 8U, 9U, 10U, 11U, 12U };
static const uint32_t REFER[] = { 1U, 5U, 9U };
static const pn_owner_t OWNER[ODD_OWNERS] = { { "supervisor" }, { "robot1" }, { "robot2" } };

/* --- what the cell's table names (`needs`) ------------------------------------------------------------------------ */

void odd_collect(const pn_net_t *net, pn_ctx_t *cx, void *marking);
void odd_collect(const pn_net_t *net, pn_ctx_t *cx, void *marking)
{
    const marking_t *const m = marking;
    pn_marking_collect(net, cx, marking);
    if (HAS(orders) && (VALUE(orders) == NO_MEMORY)) {
        pn_raise(cx, PN_ERR_MEMORY, NULL);
    }
}

bool odd_next_time(const pn_net_t *net, pn_ctx_t *cx, const void *marking, pn_time_t *next);
bool odd_next_time(const pn_net_t *net, pn_ctx_t *cx, const void *marking, pn_time_t *next)
{
    const marking_t *const m = marking;
    if (HAS(orders) && (VALUE(orders) == NO_TIME)) {
        pn_raise(cx, PN_ERR_DIV, NULL);
    }
    return pn_next_time(net, cx, marking, next);
}

/* --- the net ------------------------------------------------------------------------------------------------------ */

const pn_net_t pn_net = {
#ifdef ODD_OTHER_ABI
    .abi = PN_NET_ABI + 1U,
#else
    .abi = PN_NET_ABI,
#endif
#ifdef ODD_NAME
    .name = ODD_NAME,
#else
    .name = "odd",
#endif
    .source = "odd.cpn",
    .digest = "0000",
    .timed = true,
    .real_time = REAL_TIME,
    .marking_size = sizeof(marking_t),
    .place_count = sizeof PLACE / sizeof PLACE[0],
    .place = PLACE,
    .transition_count = sizeof TRANSITION_TABLE / sizeof TRANSITION_TABLE[0],
    .transition = TRANSITION_TABLE,
    .owner_count = ODD_OWNERS,
    .owner = OWNER,
    .order_count = sizeof ORDER / sizeof ORDER[0],
    .order = ORDER,
    .now_at = offsetof(marking_t, now),
    .set_up = set_up,
    .refer_count = sizeof REFER / sizeof REFER[0],
    .refer = REFER,
    .multiset_count = sizeof MULTISETS / sizeof MULTISETS[0],
    .multisets = MULTISETS,
};
