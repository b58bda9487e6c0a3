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
#include <stdio.h>
#include <string.h>

#include "pn/pn_net.h"
#include "pn/pn_text.h"

#ifndef HAND_DELAY
#define HAND_DELAY 2
#endif

typedef struct marking {
    int64_t now;
    uint32_t orders, idle, waiting, done, pose, command, answer, spin; /* tokens in each place: 0 or 1, `command` up to 2 */
    int64_t idle_stamp;
    int64_t n, command_value, answer_value;
    double x, y, pose_x, pose_y;
} marking_t;

typedef struct binding {
    int64_t n;
    double x, y;
} binding_t;

/* --- places ----------------------------------------------------------------------------------------------------------- */

#define COUNT(field)                                     \
    static uint64_t field##_count(const void *m)         \
    {                                                    \
        return ((const marking_t *)m)->field;            \
    }                                                    \
    static void field##_clear(void *m)                   \
    {                                                    \
        ((marking_t *)m)->field = 0U;                    \
    }

COUNT(orders) COUNT(idle) COUNT(waiting) COUNT(done) COUNT(pose) COUNT(command) COUNT(answer) COUNT(spin)

static uint32_t no_token(const void *m, uint32_t i, pn_leaf_t *leaf, uint32_t capacity)
{
    (void)m, (void)i, (void)leaf, (void)capacity;
    return 0U;
}

static bool no_put(pn_ctx_t *cx, void *m, const pn_leaf_t *leaf, uint32_t leaves)
{
    (void)m, (void)leaf, (void)leaves;
    cx->error = PN_ERR_INTERNAL;
    return false;
}

static void plain_json(const void *m, pn_text_t *out)
{
    (void)m;
    pn_text_str(out, "[[1, null]]");
}

static bool orders_put(pn_ctx_t *cx, void *m, const pn_leaf_t *leaf, uint32_t leaves)
{
    marking_t *const marking = m;
    if ((leaves != 3U) || (leaf[0].integer == 13)) { /* a colour set with a predicate: no thirteen */
        cx->error = PN_ERR_COLOUR;
        return false;
    }
    marking->orders = 1U;
    marking->n = leaf[0].integer;
    marking->x = leaf[1].real;
    marking->y = leaf[2].real;
    return true;
}

static void orders_json(const void *m, pn_text_t *out)
{
    const marking_t *const marking = m;
    pn_text_str(out, "[[1, [");
    pn_text_int(out, marking->n);
    pn_text_str(out, ", [");
    pn_text_json_real(out, marking->x);
    pn_text_str(out, ", ");
    pn_text_json_real(out, marking->y);
    pn_text_str(out, "]]]]");
}

static uint32_t pose_token(const void *m, uint32_t i, pn_leaf_t *leaf, uint32_t capacity)
{
    const marking_t *const marking = m;
    (void)i, (void)capacity;
    leaf[0].kind = PN_LEAF_REAL;
    leaf[0].real = marking->pose_x;
    leaf[1].kind = PN_LEAF_REAL;
    leaf[1].real = marking->pose_y;
    return 2U;
}

static uint32_t command_token(const void *m, uint32_t i, pn_leaf_t *leaf, uint32_t capacity)
{
    (void)i, (void)capacity;
    leaf[0].kind = PN_LEAF_INT;
    leaf[0].integer = ((const marking_t *)m)->command_value;
    return 1U;
}

static uint32_t answer_token(const void *m, uint32_t i, pn_leaf_t *leaf, uint32_t capacity)
{
    (void)i, (void)capacity;
    leaf[0].kind = PN_LEAF_INT;
    leaf[0].integer = ((const marking_t *)m)->answer_value;
    return 1U;
}

static bool answer_put(pn_ctx_t *cx, void *m, const pn_leaf_t *leaf, uint32_t leaves)
{
    marking_t *const marking = m;
    if ((leaves != 1U) || (leaf[0].integer > 9)) {
        cx->error = PN_ERR_COLOUR;
        return false;
    }
    marking->answer = 1U;
    marking->answer_value = leaf[0].integer;
    return true;
}

static const pn_leaf_kind_t ORDER_LEAF[] = {PN_LEAF_INT, PN_LEAF_REAL, PN_LEAF_REAL};
static const char *const ORDER_NAME[] = {"n", "x", "y"};
static const uint32_t ORDER_LINE[] = {1U, 2U};
static const pn_leaf_kind_t POSE_LEAF[] = {PN_LEAF_REAL, PN_LEAF_REAL};
static const char *const POSE_NAME[] = {"x", "y"};
static const pn_leaf_kind_t INT_LEAF[] = {PN_LEAF_INT};
static const char *const INT_NAME[] = {"1"};

#define PLAIN(field, place_name, place_owner, token_fn, put_fn, json_fn)                                            \
    .name = place_name, .colset = "UNIT", .origin = "page `Top`, place `" place_name "`", .owner = (place_owner),  \
    .capacity = 1U, .count = field##_count, .clear = field##_clear, .token = (token_fn), .put = (put_fn),           \
    .json = (json_fn)

static const pn_place_t PLACE[] = {
    {PLAIN(orders, "Top.Orders", 0, no_token, orders_put, orders_json), .leaf_count = 3U, .leaf_kind = ORDER_LEAF,
     .leaf_name = ORDER_NAME, .line_count = 2U, .line_leaves = ORDER_LINE},
    {PLAIN(idle, "Top.Idle", 0, no_token, no_put, plain_json), .timed = true},
    {PLAIN(waiting, "Top.Waiting", 0, no_token, no_put, plain_json)},
    {PLAIN(done, "Top.Done", 0, no_token, no_put, plain_json)},
    {PLAIN(pose, "Top.pose1", -1, pose_token, no_put, plain_json), .leaf_count = 2U, .leaf_kind = POSE_LEAF,
     .leaf_name = POSE_NAME},
    {PLAIN(command, "Top.command", -1, command_token, no_put, plain_json), .leaf_count = 1U, .leaf_kind = INT_LEAF,
     .leaf_name = INT_NAME},
    {PLAIN(answer, "Top.answer", -1, answer_token, answer_put, plain_json), .leaf_count = 1U, .leaf_kind = INT_LEAF,
     .leaf_name = INT_NAME},
    {PLAIN(spin, "Top.Spin", 0, no_token, no_put, plain_json)},
};

/* --- transitions ------------------------------------------------------------------------------------------------------ */

static bool offer(const marking_t *m, bool enabled, uint32_t self, pn_binding_sink_t sink, void *user)
{
    const binding_t binding = {m->n, m->x, m->y};
    return !enabled || sink(user, self, &binding);
}

#define ENUMERATE(transition, condition)                                                                                  \
    static bool transition##_enumerate(pn_ctx_t *cx, const void *marking, uint32_t self, pn_binding_sink_t sink, void *user) \
    {                                                                                                                     \
        const marking_t *const m = marking;                                                                               \
        (void)cx;                                                                                                         \
        return offer(m, (condition), self, sink, user);                                                                   \
    }

static bool is_idle(const marking_t *m)
{
    return (m->idle > 0U) && (m->idle_stamp <= m->now);
}

ENUMERATE(send, (m->orders > 0U) && (m->n > 0) && is_idle(m))
ENUMERATE(next, (m->waiting > 0U) && (m->answer > 0U) && (m->answer_value == 1))
ENUMERATE(finish, (m->orders > 0U) && (m->n <= 0) && is_idle(m))
ENUMERATE(overflow, (m->answer > 0U) && (m->answer_value == 2))
ENUMERATE(again, (m->answer > 0U) && (m->answer_value == 3))
ENUMERATE(spin, ((m->answer > 0U) && (m->answer_value == 4)) || (m->spin > 0U))
ENUMERATE(work, (m->command > 0U) && (m->pose > 0U))

static bool send_fire(pn_ctx_t *cx, void *marking, void *binding)
{
    marking_t *const m = marking;
    (void)cx, (void)binding;
    m->orders = 0U;
    m->idle = 0U;
    m->waiting = 1U;
    m->pose = 1U;
    m->pose_x = m->x;
    m->pose_y = m->y;
    m->command = 1U;
    m->command_value = 1;
    return true;
}

static bool next_fire(pn_ctx_t *cx, void *marking, void *binding)
{
    marking_t *const m = marking;
    (void)cx, (void)binding;
    m->waiting = 0U;
    m->answer = 0U;
    m->n -= 1;
    m->x += 0.1;
    m->orders = 1U;
    m->idle = 1U;
    m->idle_stamp = m->now + HAND_DELAY;
    return true;
}

static bool finish_fire(pn_ctx_t *cx, void *marking, void *binding)
{
    marking_t *const m = marking;
    (void)cx, (void)binding;
    m->orders = 0U;
    m->idle = 0U;
    m->done = 1U;
    return true;
}

static bool overflow_fire(pn_ctx_t *cx, void *marking, void *binding)
{
    (void)marking, (void)binding;
    cx->error = PN_ERR_OVERFLOW;
    cx->error_name = "Overflow";
    cx->error_origin = "page `Top`, transition `Trouble` (ID77)";
    return false;
}

static bool again_fire(pn_ctx_t *cx, void *marking, void *binding)
{
    marking_t *const m = marking;
    (void)cx, (void)binding;
    m->answer = 0U;
    m->command = 1U;
    m->command_value = 3;
    return true;
}

static bool spin_fire(pn_ctx_t *cx, void *marking, void *binding)
{
    marking_t *const m = marking;
    (void)cx, (void)binding;
    m->answer = 0U;
    m->spin = 1U;
    return true;
}

static bool work_fire(pn_ctx_t *cx, void *marking, void *binding)
{
    marking_t *const m = marking;
    (void)cx, (void)binding;
    m->command = 0U;
    m->pose = 0U;
    m->answer = 1U;
    m->answer_value = 1;
    return true;
}

static void binding_json(const void *binding, pn_text_t *out)
{
    const binding_t *const b = binding;
    pn_text_str(out, "{\"n\": ");
    pn_text_int(out, b->n);
    pn_text_str(out, ", \"x\": ");
    pn_text_json_real(out, b->x);
    pn_text_char(out, '}');
}

#define TRANSITION(fn, full, owned)                                                                         \
    {                                                                                                       \
        .name = (full), .id = "ID" #fn, .origin = "page `Top`, transition `" full "`", .owner = (owned),    \
        .priority = 1000, .enumerate = fn##_enumerate, .fire = fn##_fire, .binding_json = binding_json,     \
        .binding_size = sizeof(binding_t)                                                                   \
    }

static const pn_transition_t TRANSITION_TABLE[] = {
    TRANSITION(send, "Top.Send", 0),         TRANSITION(next, "Top.Next", 0),   TRANSITION(finish, "Top.Finish", 0),
    TRANSITION(overflow, "Top.Trouble", 0),  TRANSITION(again, "Top.Again", 0), TRANSITION(spin, "Top.Spin", 0),
    TRANSITION(work, "Top.Robot.Do", 1),
};

static const uint32_t ORDER[] = {0U, 1U, 2U, 3U, 4U, 5U, 6U};
static const pn_owner_t OWNER[] = {{"supervisor"}, {"robot1"}};

/* --- the net ---------------------------------------------------------------------------------------------------------- */

static bool init(pn_ctx_t *cx, void *marking)
{
    marking_t *const m = marking;
    (void)cx;
    (void)memset(m, 0, sizeof *m);
    m->orders = 1U;
    m->n = 2;
    m->x = 0.5;
    m->y = 7.0;
    m->idle = 1U;
    return true;
}

static pn_time_t now(const void *marking)
{
    return (pn_time_t){.integer = ((const marking_t *)marking)->now};
}

static void set_now(void *marking, pn_time_t time)
{
    ((marking_t *)marking)->now = time.integer;
}

static bool next_time(pn_ctx_t *cx, const void *marking, pn_time_t *next)
{
    (void)cx;
    const marking_t *const m = marking;
    next->integer = m->idle_stamp;
    return (m->idle > 0U) && (m->idle_stamp > m->now);
}

static size_t encode(const void *marking, uint8_t *out, size_t capacity)
{
    (void)marking, (void)out, (void)capacity;
    return 0U;
}

static bool decode(pn_ctx_t *cx, void *marking, const uint8_t *in, size_t length)
{
    (void)cx, (void)marking, (void)in, (void)length;
    return false;
}

static void collect(pn_ctx_t *cx, void *marking)
{
    (void)cx, (void)marking;
}

const pn_net_t pn_net = {
    .abi = PN_NET_ABI,
    .name = "hand",
    .source = "hand.cpn",
    .digest = "0000",
    .timed = true,
    .marking_size = sizeof(marking_t),
    .binding_size = sizeof(binding_t),
    .place_count = sizeof PLACE / sizeof PLACE[0],
    .place = PLACE,
    .transition_count = sizeof TRANSITION_TABLE / sizeof TRANSITION_TABLE[0],
    .transition = TRANSITION_TABLE,
    .owner_count = 2U,
    .owner = OWNER,
    .order_count = sizeof ORDER / sizeof ORDER[0],
    .order = ORDER,
    .init = init,
    .now = now,
    .set_now = set_now,
    .next_time = next_time,
    .encode = encode,
    .decode = decode,
    .collect = collect,
};
