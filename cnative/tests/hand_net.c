/* SPDX-License-Identifier: MIT
 * hand_net.c - a pn_net written by hand, to drive the supervisor host without the generator.
 *
 *   Orders (n, x, y) --Send--> pose1 (x, y), command 1, Waiting     while n > 0
 *   Waiting, answer 1 --Next--> Orders (n - 1, x + 0.1, y), Idle@+HAND_DELAY
 *   Orders (0, x, y) --Finish--> Done
 *   command 1, pose1 --Robot.Do--> answer 1                         (the robot's only transition)
 *
 * and for trouble: answer 2 raises Overflow, answer 3 sends the command again at once, answer 4 never comes to rest.
 */
#include <stddef.h>

#include "pn/pn_multiset.h"
#include "pn/pn_net.h"

#ifndef HAND_DELAY
#define HAND_DELAY 2
#endif

typedef struct position {
    double x, y;
} position_t;

typedef struct order {
    int64_t n;
    position_t at;
} order_t;

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
    PLACE_OF(order_t) orders;
    PLACE_OF(uint8_t) idle;
    PLACE_OF(uint8_t) waiting;
    PLACE_OF(uint8_t) done;
    PLACE_OF(position_t) pose;
    PLACE_OF(int64_t) command;
    PLACE_OF(int64_t) answer;
    PLACE_OF(uint8_t) spin;
} marking_t;

typedef struct binding {
    int64_t n;
    double x;
} binding_t;

/* --- colour sets -------------------------------------------------------------------------------------------------- */

static bool is_no_thirteen(pn_ctx_t *cx, const void *value)
{
    (void)cx;
    return ((const order_t *)value)->n != 13;
}

static const pn_type_t UNIT = { .kind = PN_KIND_UNIT, .name = "UNIT", .size = sizeof(uint8_t) };
static const pn_type_t REAL = { .kind = PN_KIND_REAL, .name = "REAL", .size = sizeof(double) };
static const pn_type_t INT = { .kind = PN_KIND_INT, .name = "INT", .size = sizeof(int64_t) };
static const pn_type_t ANSWER = { .kind = PN_KIND_INT,
                                  .name = "ANSWER",
                                  .size = sizeof(int64_t),
                                  .has_range = true,
                                  .low = INT64_MIN,
                                  .high = 9 };
static const pn_field_t POSITION_FIELD[] = { { "1", &REAL, offsetof(position_t, x), false },
                                             { "2", &REAL, offsetof(position_t, y), false } };
static const pn_part_t POSITION_PART[] = { { &REAL, offsetof(position_t, x) }, { &REAL, offsetof(position_t, y) } };
static const pn_type_t POSITION = { .kind = PN_KIND_RECORD,
                                    .name = "POSITION",
                                    .size = sizeof(position_t),
                                    .is_tuple = true,
                                    .count = 2U,
                                    .field = POSITION_FIELD,
                                    .part_count = 2U,
                                    .part = POSITION_PART };
static const pn_field_t ORDER_FIELD[] = { { "1", &INT, offsetof(order_t, n), false },
                                          { "2", &POSITION, offsetof(order_t, at), false } };
static const pn_part_t ORDER_PART[] = { { &INT, offsetof(order_t, n) },
                                        { &REAL, offsetof(order_t, at.x) },
                                        { &REAL, offsetof(order_t, at.y) } };
static const pn_type_t ORDER_TYPE = { .kind = PN_KIND_RECORD,
                                      .name = "ORDER",
                                      .size = sizeof(order_t),
                                      .is_tuple = true,
                                      .count = 2U,
                                      .field = ORDER_FIELD,
                                      .part_count = 3U,
                                      .part = ORDER_PART,
                                      .member = is_no_thirteen };
static const pn_field_t BINDING_FIELD[] = { { "n", &INT, offsetof(binding_t, n), false },
                                            { "x", &REAL, offsetof(binding_t, x), false } };
static const pn_type_t BINDING = { .kind = PN_KIND_RECORD,
                                   .name = "binding",
                                   .size = sizeof(binding_t),
                                   .count = 2U,
                                   .field = BINDING_FIELD };

/* --- places ------------------------------------------------------------------------------------------------------- */

#define MULTISET(field, place_name, value_type, timed)                                              \
    static const pn_multiset_t field##_multiset = { .origin = "page `Top`, place `" place_name "`", \
                                                    .type = &(value_type),                          \
                                                    .capacity = 1U,                                 \
                                                    .is_timed = (timed),                            \
                                                    PN_MULTISET_STAMPS(marking_t, field) };

MULTISET(orders, "Top.Orders", ORDER_TYPE, false)
MULTISET(idle, "Top.Idle", UNIT, true)
MULTISET(waiting, "Top.Waiting", UNIT, false)
MULTISET(done, "Top.Done", UNIT, false)
MULTISET(pose, "Top.pose1", POSITION, false)
MULTISET(command, "Top.command", INT, false)
MULTISET(answer, "Top.answer", ANSWER, false)
MULTISET(spin, "Top.Spin", UNIT, false)

/* A token in a place where there is none, or another one instead. */
#define PUT(field, token_value)                  \
    do {                                         \
        m->field.used = 1U;                      \
        m->field.token[0].value = (token_value); \
        m->field.token[0].count = 1U;            \
    } while (false)
#define TAKE(field)  (m->field.used = 0U)
#define HAS(field)   (m->field.used > 0U)
#define VALUE(field) (m->field.token[0].value)

static bool begin(pn_ctx_t *cx, void *marking)
{
    marking_t *const m = marking;
    const order_t order = { 2, { 0.5, 7.0 } };
    (void)cx;
    PUT(orders, order);
    PUT(idle, 0U);
    m->idle.token[0].stamp = (pn_time_t){ .integer = 0 };
    return true;
}

#define PLAIN(field, place_name, place_owner) \
    .name = place_name, .colset = "UNIT", .owner = (place_owner), .multiset = &field##_multiset

static const pn_place_t PLACE[] = {
    { PLAIN(orders, "Top.Orders", 0), .initial = begin },
    { PLAIN(idle, "Top.Idle", 0) },
    { PLAIN(waiting, "Top.Waiting", 0) },
    { PLAIN(done, "Top.Done", 0) },
    { PLAIN(pose, "Top.pose1", -1) },
    { PLAIN(command, "Top.command", -1) },
    { PLAIN(answer, "Top.answer", -1) },
    { PLAIN(spin, "Top.Spin", 0) },
};

/* --- transitions -------------------------------------------------------------------------------------------------- */

static bool offer(const marking_t *m, bool enabled, uint32_t self, pn_binding_sink_t sink, void *user)
{
    const binding_t binding = { VALUE(orders).n, VALUE(orders).at.x };
    return !enabled || sink(user, self, &binding);
}

#define ENUMERATE(transition, condition)                                                                         \
    static bool transition##_enumerate(pn_ctx_t *cx, const void *marking, uint32_t self, pn_binding_sink_t sink, \
                                       void *user)                                                               \
    {                                                                                                            \
        const marking_t *const m = marking;                                                                      \
        (void)cx;                                                                                                \
        return offer(m, (condition), self, sink, user);                                                          \
    }

static bool is_idle(const marking_t *m)
{
    return HAS(idle) && (m->idle.token[0].stamp.integer <= m->now.integer);
}

ENUMERATE(send, HAS(orders) && (VALUE(orders).n > 0) && is_idle(m))
ENUMERATE(next, HAS(waiting) && HAS(answer) && (VALUE(answer) == 1))
ENUMERATE(finish, HAS(orders) && (VALUE(orders).n <= 0) && is_idle(m))
ENUMERATE(overflow, HAS(answer) && (VALUE(answer) == 2))
ENUMERATE(again, HAS(answer) && (VALUE(answer) == 3))
ENUMERATE(spin, (HAS(answer) && (VALUE(answer) == 4)) || HAS(spin))
ENUMERATE(work, HAS(command) && HAS(pose))

static bool send_fire(pn_ctx_t *cx, void *marking, uint32_t self, void *binding)
{
    marking_t *const m = marking;
    (void)cx, (void)self, (void)binding;
    TAKE(orders);
    TAKE(idle);
    PUT(waiting, 0U);
    PUT(pose, VALUE(orders).at);
    PUT(command, 1);
    return true;
}

static bool next_fire(pn_ctx_t *cx, void *marking, uint32_t self, void *binding)
{
    marking_t *const m = marking;
    const order_t rest = { VALUE(orders).n - 1, { VALUE(orders).at.x + 0.1, VALUE(orders).at.y } };
    (void)cx, (void)self, (void)binding;
    TAKE(waiting);
    TAKE(answer);
    PUT(orders, rest);
    PUT(idle, 0U);
    m->idle.token[0].stamp.integer = m->now.integer + HAND_DELAY;
    return true;
}

static bool finish_fire(pn_ctx_t *cx, void *marking, uint32_t self, void *binding)
{
    marking_t *const m = marking;
    (void)cx, (void)self, (void)binding;
    TAKE(orders);
    TAKE(idle);
    PUT(done, 0U);
    return true;
}

static bool overflow_fire(pn_ctx_t *cx, void *marking, uint32_t self, void *binding)
{
    (void)marking, (void)self, (void)binding;
    cx->error = PN_ERR_OVERFLOW;
    cx->error_name = "Overflow";
    cx->error_origin = "page `Top`, transition `Trouble` (ID77)";
    return false;
}

static bool again_fire(pn_ctx_t *cx, void *marking, uint32_t self, void *binding)
{
    marking_t *const m = marking;
    (void)cx, (void)self, (void)binding;
    TAKE(answer);
    PUT(command, 3);
    return true;
}

static bool spin_fire(pn_ctx_t *cx, void *marking, uint32_t self, void *binding)
{
    marking_t *const m = marking;
    (void)cx, (void)self, (void)binding;
    TAKE(answer);
    PUT(spin, 0U);
    return true;
}

static bool work_fire(pn_ctx_t *cx, void *marking, uint32_t self, void *binding)
{
    marking_t *const m = marking;
    (void)cx, (void)self, (void)binding;
    TAKE(command);
    TAKE(pose);
    PUT(answer, 1);
    return true;
}

#define TRANSITION(fn, full, owned)                  \
    { .name = (full),                                \
      .id = "ID" #fn,                                \
      .origin = "page `Top`, transition `" full "`", \
      .owner = (owned),                              \
      .priority = 1000,                              \
      .enumerate = fn##_enumerate,                   \
      .fire = fn##_fire,                             \
      .binding = &BINDING }

static const pn_transition_t TRANSITION_TABLE[] = {
    TRANSITION(send, "Top.Send", 0),        TRANSITION(next, "Top.Next", 0),   TRANSITION(finish, "Top.Finish", 0),
    TRANSITION(overflow, "Top.Trouble", 0), TRANSITION(again, "Top.Again", 0), TRANSITION(spin, "Top.Spin", 0),
    TRANSITION(work, "Top.Robot.Do", 1),
};

static const uint32_t ORDER[] = { 0U, 1U, 2U, 3U, 4U, 5U, 6U };
static const uint32_t MULTISETS[] = { 0U, 1U, 2U, 3U, 4U, 5U, 6U, 7U };
static const pn_owner_t OWNER[] = { { "supervisor" }, { "robot1" } };

/* --- the net ------------------------------------------------------------------------------------------------------ */

const pn_net_t pn_net = {
    .abi = PN_NET_ABI,
    .name = "hand",
    .source = "hand.cpn",
    .digest = "0000",
    .timed = true,
    .marking_size = sizeof(marking_t),
    .place_count = sizeof PLACE / sizeof PLACE[0],
    .place = PLACE,
    .transition_count = sizeof TRANSITION_TABLE / sizeof TRANSITION_TABLE[0],
    .transition = TRANSITION_TABLE,
    .owner_count = 2U,
    .owner = OWNER,
    .order_count = sizeof ORDER / sizeof ORDER[0],
    .order = ORDER,
    .now_at = offsetof(marking_t, now),
    .multiset_count = sizeof MULTISETS / sizeof MULTISETS[0],
    .multisets = MULTISETS,
};
