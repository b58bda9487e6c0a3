/* SPDX-License-Identifier: MIT
 * runtime.c - tests of the runtime: texts, arena, places, moves. Exit code 0 and "ok" when all hold.
 *
 *     runtime           all tests
 *     runtime --repr    reads bit patterns of doubles in hex, one a line, and writes the shortest decimal of each
 */
#define _POSIX_C_SOURCE 200809L /* mkstemp */

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "pn/pn_arena.h"
#include "pn/pn_multiset.h"
#include "pn/pn_num.h"
#include "pn/pn_text.h"
#include "pn/pn_trace.h"

#include "../src/value/pn_bytes_impl.h"

static int s_failures = 0;

static void check(bool holds, const char *what, int line)
{
    if (!holds) {
        s_failures++;
        (void)fprintf(stderr, "runtime.c:%d: %s\n", line, what);
    }
}

#define CHECK(condition) check((condition), #condition, __LINE__)

static max_align_t s_memory[4096];

/* A net of two places of integers: one plain, one timed with room for three. */
typedef struct marking {
    struct {
        uint32_t used;
        struct {
            int64_t value;
            uint32_t count;
        } token[4];
    } Plain;
    struct {
        uint32_t used;
        struct {
            int64_t value;
            uint32_t count;
            pn_time_t stamp;
        } token[3];
    } Timed;
} marking_t;

static const pn_type_t s_int = { .kind = PN_KIND_INT, .name = "INT", .size = sizeof(int64_t) };
static const pn_type_t s_small = { .kind = PN_KIND_INT,
                                   .name = "SMALL",
                                   .size = sizeof(int64_t),
                                   .has_range = true,
                                   .low = 1,
                                   .high = 3 };
static const pn_multiset_t s_plain = { .origin = "place `Plain`",
                                       .type = &s_int,
                                       .capacity = 4U,
                                       PN_MULTISET_TOKENS(marking_t, Plain) };
static const pn_multiset_t s_timed = { .origin = "place `Timed`",
                                       .type = &s_int,
                                       .capacity = 3U,
                                       .is_timed = true,
                                       PN_MULTISET_STAMPS(marking_t, Timed) };

/* The text of a place's marking. */
static const char *json(const pn_multiset_t *multiset, const marking_t *m)
{
    static char buffer[512];
    pn_text_t text;
    pn_text_init(&text, buffer, sizeof buffer);
    pn_multiset_json(multiset, m, &text);
    return buffer;
}

static bool is_text(const char *a, const char *b)
{
    return strcmp(a, b) == 0;
}

static void test_text(void)
{
    char buffer[8];
    pn_text_t text;
    pn_text_init(&text, buffer, sizeof buffer);
    pn_text_str(&text, "abcdef");
    CHECK(!text.truncated);
    pn_text_str(&text, "xyz");
    CHECK(text.truncated);
    CHECK(is_text(buffer, "abcdefx"));
    pn_text_clear(&text);
    CHECK(!text.truncated && is_text(buffer, ""));
    pn_text_int(&text, INT64_MIN);
    CHECK(text.truncated && is_text(buffer, "-922337"));

    char wide[64];
    pn_text_init(&text, wide, sizeof wide);
    pn_text_json_bytes(&text, "a\"\\\n\x01\xC3\xA9\xE9", 8U);
    CHECK(is_text(wide, "\"a\\\"\\\\\\n\\u0001\xC3\xA9\xC3\xA9\""));
    pn_text_clear(&text);
    pn_text_json_string(&text, "a\"\xC3\xA9\xE9", 5U); /* of CPN ML: one character a byte */
    CHECK(is_text(wide, "\"a\\\"\xC3\x83\xC2\xA9\xC3\xA9\""));
    pn_text_clear(&text);
    pn_text_fixed(&text, -0.00001, 4);
    pn_text_char(&text, ' ');
    pn_text_fixed(&text, -1.00006, 4);
    CHECK(is_text(wide, "0.0000 -1.0001"));
}

static void test_numbers(void)
{
    pn_arena_t arena;
    pn_ctx_t cx;
    pn_arena_init(&arena, s_memory, sizeof s_memory);
    pn_ctx_init(&cx, &arena, 1U);
    CHECK(pn_int_div(&cx, -7, 2) == -4);
    CHECK(pn_int_mod(&cx, -7, 2) == 1);
    CHECK(pn_int_quot(&cx, -7, 2) == -3);
    CHECK(pn_int_rem(&cx, -7, 2) == -1);
    CHECK(pn_int_mod(&cx, 7, -2) == -1);
    CHECK(pn_real_round(&cx, 2.5) == 2);
    CHECK(pn_real_round(&cx, 3.5) == 4);
    CHECK(pn_real_round(&cx, -2.5) == -2);
    CHECK(pn_real_floor(&cx, -0.5) == -1);
    CHECK(pn_ok(&cx));
    CHECK(pn_int_add(&cx, PN_INT_MAX, 1) == 0);
    CHECK(cx.error == PN_ERR_OVERFLOW);
    CHECK(pn_int_div(&cx, 1, 0) == 0);
    CHECK(cx.error == PN_ERR_OVERFLOW); /* the first error stays */
    pn_clear_error(&cx);
    CHECK(pn_time_sum(&cx, INT64_MAX, 1) == 0);
    CHECK(cx.error == PN_ERR_LARGE);
    CHECK(!pn_is_exception(&cx));
    pn_clear_error(&cx);
    CHECK(pn_wide_mul(&cx, INT64_MIN, -1) == 0);
    CHECK(cx.error == PN_ERR_OVERFLOW);
    pn_clear_error(&cx);
    CHECK(pn_wide_mul(&cx, INT64_C(3037000499), INT64_C(3037000499)) == INT64_C(9223372030926249001));
    CHECK(pn_ok(&cx));
    CHECK(pn_real_floor(&cx, 1e300) == 0);
    CHECK(cx.error == PN_ERR_OVERFLOW);

    char text[40];
    static const struct {
        double value;
        const char *sml;
    } reals[] = {
        { 1.0 / 3.0, "0.333333333333" },
        { 1e-5, "1E~05" },
        { -1.5, "~1.5" },
        { 2.0, "2.0" },
        { 123456789012.0, "123456789012.0" },
        { 1e12, "1E12" },
        { 0.0, "0.0" },
        { -0.0, "~0.0" },
        { 0.001, "0.001" },
    };
    for (size_t i = 0U; i < (sizeof reals / sizeof reals[0]); i++) {
        (void)pn_real_sml(text, sizeof text, reals[i].value);
        if (strcmp(text, reals[i].sml) != 0) {
            (void)fprintf(stderr, "%s is written %s\n", reals[i].sml, text);
            s_failures++;
        }
    }
}

static void test_arena(void)
{
    pn_arena_t arena;
    pn_ctx_t cx;
    pn_arena_init(&arena, s_memory, 1024U);
    pn_ctx_init(&cx, &arena, 1U);
    const pn_string_t kept = pn_string_make(&cx, "kept", 4U);
    pn_arena_seal(&arena);
    const size_t mark = pn_arena_mark(&arena);
    CHECK(pn_arena_alloc(&cx, 100U) != NULL);
    pn_arena_release(&arena, mark);
    CHECK(pn_arena_mark(&arena) == mark);
    CHECK(pn_arena_alloc(&cx, arena.half) != NULL);
    CHECK(pn_arena_is_crowded(&arena));
    CHECK(pn_arena_alloc(&cx, 1U) == NULL);
    CHECK(cx.error == PN_ERR_MEMORY);
    pn_arena_flip(&arena);
    pn_clear_error(&cx);
    CHECK(pn_string_make(&cx, "", 0U).length == 0U);
    const pn_string_t more = pn_string_concat(&cx, kept, pn_string_make(&cx, "!", 1U));
    CHECK((more.length == 5U) && is_text(more.bytes, "kept!"));
    CHECK(pn_ok(&cx));
}

static void test_moves(void)
{
    pn_arena_t arena;
    pn_ctx_t cx;
    marking_t m;
    (void)memset(&m, 0, sizeof m);
    pn_arena_init(&arena, s_memory, sizeof s_memory);
    pn_ctx_init(&cx, &arena, 1U);
    const int64_t one = 1;
    const int64_t two = 2;
    const int64_t three = 3;
    CHECK(pn_multiset_add(&cx, &s_plain, &m, &two, 1U, PN_NO_TIME));
    CHECK(pn_multiset_add(&cx, &s_plain, &m, &one, 2U, PN_NO_TIME));
    CHECK(is_text(json(&s_plain, &m), "[[2, 1], [1, 2]]"));

    /* Demands on one place sum up. */
    pn_moves_t moves;
    pn_moves_init(&moves, &cx);
    pn_moves_take(&moves, &s_plain, &one, 1, PN_NO_TIME);
    pn_moves_take(&moves, &s_plain, &one, 1, PN_NO_TIME);
    CHECK(pn_moves_are_possible(&moves, &m));
    pn_moves_take(&moves, &s_plain, &one, 1, PN_NO_TIME);
    CHECK(!pn_moves_are_possible(&moves, &m));

    /* Timed: stamps 1, 4, 9 of value 1. A demand up to 2 and one up to 5 can be met, two up to 2 cannot. */
    CHECK(pn_multiset_add(&cx, &s_timed, &m, &one, 1U, pn_time_int(9)));
    CHECK(pn_multiset_add(&cx, &s_timed, &m, &one, 1U, pn_time_int(1)));
    CHECK(pn_multiset_add(&cx, &s_timed, &m, &one, 1U, pn_time_int(4)));
    CHECK(is_text(json(&s_timed, &m), "[[1, 1, 1], [1, 1, 4], [1, 1, 9]]"));
    CHECK(pn_multiset_available(&s_timed, &m, pn_time_int(4)) == 2U);
    pn_moves_init(&moves, &cx);
    pn_moves_take(&moves, &s_timed, &one, 1, pn_time_int(5));
    pn_moves_take(&moves, &s_timed, &one, 1, pn_time_int(2));
    CHECK(pn_moves_are_possible(&moves, &m));
    pn_moves_t more = moves;
    pn_moves_take(&more, &s_timed, &one, 1, pn_time_int(2));
    CHECK(!pn_moves_are_possible(&more, &m));

    /* A firing that finds no room changes nothing: the timed place has three entries, two are taken, four are put. */
    const marking_t before = m;
    pn_moves_init(&moves, &cx);
    pn_moves_take(&moves, &s_timed, &one, 2, pn_time_int(9));
    pn_moves_take(&moves, &s_plain, &two, 1, PN_NO_TIME);
    for (int64_t i = 0; i < 4; i++) {
        pn_moves_put(&moves, &s_timed, &three, 1, pn_time_int(20 + i));
    }
    CHECK(!pn_moves_commit(&moves, &m));
    CHECK(cx.error == PN_ERR_CAPACITY);
    CHECK(is_text(cx.error_origin, "place `Timed`"));
    CHECK(memcmp(&before, &m, sizeof m) == 0);
    pn_clear_error(&cx);

    /* The latest admissible token is taken; a reset leaves what is not available yet. */
    pn_moves_init(&moves, &cx);
    pn_moves_take(&moves, &s_timed, &one, 1, pn_time_int(5));
    pn_moves_put(&moves, &s_timed, &two, 1, pn_time_int(7));
    pn_moves_reset(&moves, &s_timed, pn_time_int(7));
    CHECK(pn_moves_commit(&moves, &m));
    CHECK(is_text(json(&s_timed, &m), "[[1, 1, 9]]"));

    /* A colour outside its colour set. */
    pn_multiset_t small = s_plain;
    small.type = &s_small;
    const int64_t four = 4;
    pn_moves_init(&moves, &cx);
    pn_moves_put(&moves, &small, &four, 1, PN_NO_TIME);
    CHECK(!pn_moves_commit(&moves, &m));
    CHECK(cx.error == PN_ERR_COLOUR);
    CHECK(is_text(cx.error_name, "illegal colour 4: it is not in the colour set `SMALL`"));
    CHECK(is_text(cx.error_origin, "place `Plain`"));
}

/* What is said of a value: on one line, and so much that it stays a sentence. */
static void test_colours_that_are_said(void)
{
    static const char s_long[] = "a long name of a colour set, which goes on and on until it is longer than is said";
    static const pn_type_t word = { .kind = PN_KIND_STRING, .name = s_long, .size = sizeof(pn_string_t) };
    char text[1000];
    pn_arena_t arena;
    pn_ctx_t cx;
    pn_arena_init(&arena, NULL, 0U);
    pn_ctx_init(&cx, &arena, 1U);
    (void)memset(text, 'x', sizeof text);
    (void)memcpy(&text[100], "\n\"\t\303\244", 5U);
    pn_string_t value = { text, 120U };
    pn_raise_colour(&cx, &word, &value);
    CHECK((cx.error == PN_ERR_COLOUR) && (strncmp(cx.error_name, "illegal colour \"xxx", 19U) == 0));
    CHECK(strstr(cx.error_name, "xx?\"?\303\244xxxxxxxxxxxxxxx\": it is not in") != NULL);
    CHECK(strstr(cx.error_name, "it is not in the colour set `a long name of") != NULL);
    CHECK(strstr(cx.error_name, "...`") != NULL);
    for (uint32_t start = 100U; start < 130U; start++) { /* wherever it is cut, no character is cut in two */
        (void)memset(text, 'x', sizeof text);
        for (uint32_t i = start; i < 200U; i += 2U) {
            (void)memcpy(&text[i], "\303\244", 2U);
        }
        value.length = sizeof text;
        pn_clear_error(&cx);
        pn_raise_colour(&cx, &word, &value);
        CHECK((strstr(cx.error_name, "\303\244...: it is not in") != NULL)
              || ((start > 120U) && (strstr(cx.error_name, "x...: it is not in") != NULL)));
        CHECK(strlen(cx.error_name) < PN_SAID_SIZE);
    }
    pn_raise(&cx, PN_ERR_DIV, NULL); /* the first error counts */
    CHECK(cx.error == PN_ERR_COLOUR);
}

/* Numbers as bytes: what is read is what was written, in the shortest form, which is the only one that is read. */
/* A word of at most three characters that has arrived. */
static void test_arrivals(void)
{
    static const pn_type_t word = {
        .kind = PN_KIND_STRING, .name = "WORD", .size = sizeof(pn_string_t), .has_range = true, .low = 0, .high = 3
    };
    struct words {
        struct {
            pn_string_t value;
            bool full;
        } Word;
    } words;
    static const pn_multiset_t place = {
        .origin = "place `Word`", .type = &word, .capacity = 1U, PN_MULTISET_SLOT(struct words, Word)
    };
    pn_arena_t arena;
    pn_ctx_t cx;
    marking_t m;
    (void)memset(&m, 0, sizeof m);
    (void)memset(&words, 0, sizeof words);
    pn_arena_init(&arena, NULL, 0U); /* numbers need none */
    pn_ctx_init(&cx, &arena, 1U);
    pn_arena_seal(&arena);
    const pn_scalar_value_t number = { .kind = PN_VALUE_INT, .integer = 2 };
    CHECK(pn_multiset_put(&cx, &s_plain, &m, &number, 1U) && is_text(json(&s_plain, &m), "[[1, 2]]"));
    CHECK(pn_ok(&cx));

    pn_arena_init(&arena, s_memory, 512U);
    pn_arena_seal(&arena);
    const pn_scalar_value_t longer = { .kind = PN_VALUE_STRING, .text = "longer", .length = 6U };
    const pn_scalar_value_t fine = { .kind = PN_VALUE_STRING, .text = "abc", .length = 3U };
    for (uint32_t i = 0U; i < 100U; i++) { /* it is sent again and again */
        CHECK(!pn_multiset_put(&cx, &place, &words, &longer, 1U) && (cx.error == PN_ERR_COLOUR));
        pn_clear_error(&cx);
    }
    CHECK(pn_arena_mark(&arena) == 0U);
    CHECK(pn_multiset_put(&cx, &place, &words, &fine, 1U) && (pn_arena_mark(&arena) > 0U));
    CHECK(words.Word.full && (words.Word.value.length == 3U) && is_text(words.Word.value.bytes, "abc"));
}

static void test_bytes(void)
{
    static const int64_t integers[] = { 0, -1, 1, 63, -64, 64, -65, 8191, 8192, INT64_MAX, INT64_MIN };
    static const double reals[] = { 0.0, -0.0, 1.0, -2.5, 0.1, 1e-310, 1e300 };
    uint8_t bytes[16];
    for (size_t i = 0U; i < (sizeof integers / sizeof integers[0]); i++) {
        const size_t length = put_integer(bytes, sizeof bytes, 0U, integers[i]);
        int64_t back = 77;
        size_t at = 0U;
        CHECK(get_integer(bytes, length, &at, &back) && (back == integers[i]) && (at == length));
        CHECK(put_integer(bytes, length - 1U, 0U, integers[i]) == length);
        at = 0U;
        CHECK(!get_integer(bytes, length - 1U, &at, &back));
    }
    for (size_t i = 0U; i < (sizeof reals / sizeof reals[0]); i++) {
        const size_t length = put_real(bytes, sizeof bytes, 0U, reals[i]);
        double back = 77.0;
        size_t at = 0U;
        CHECK(get_real(bytes, length, &at, &back) && (memcmp(&back, &reals[i], sizeof back) == 0) && (at == length));
        at = 0U;
        CHECK(!get_real(bytes, length - 1U, &at, &back));
    }
    CHECK(put_integer(bytes, sizeof bytes, 0U, -64) == 1U);
    CHECK(put_real(bytes, sizeof bytes, 0U, -2.5) == 3U);
    static const uint8_t longer[] = { 0x80U, 0x00U };
    static const uint8_t beyond[] = { 0xffU, 0xffU, 0xffU, 0xffU, 0xffU, 0xffU, 0xffU, 0xffU, 0xffU, 0x02U };
    static const uint8_t zero[] = { 2U, 0U, 0x40U };
    uint64_t number = 0U;
    double real = 0.0;
    size_t at = 0U;
    CHECK(!get_number(longer, sizeof longer, &at, &number));
    at = 0U;
    CHECK(!get_number(beyond, sizeof beyond, &at, &number));
    at = 0U;
    CHECK(!get_real(zero, sizeof zero, &at, &real));
}

static void test_trace(void)
{
    char line[64];
    pn_trace_t trace;
    CHECK(pn_trace_open(&trace, NULL, line, sizeof line));
    pn_trace_note(&trace, 1.0, "tool", NULL);
    CHECK(pn_trace_close(&trace));
    CHECK(!pn_trace_open(&trace, "/nonexistent/folder/x", line, sizeof line));
    /* A line that is longer than the buffer is written part by part. */
    char path[] = "/tmp/pn2code-trace-XXXXXX";
    const int made = mkstemp(path);
    CHECK(made >= 0);
    CHECK(pn_trace_open(&trace, path, line, sizeof line));
    pn_trace_note(&trace, 1.0, "a name that is too long for a buffer of sixty-four characters", NULL);
    CHECK(pn_trace_close(&trace));
    char whole[256] = "";
    FILE *const file = fopen(path, "r");
    CHECK((file != NULL) && (fgets(whole, (int)sizeof whole, file) != NULL));
    CHECK(strcmp(whole, "{\"t\": 1.0, \"event\": \"a name that is too long for a buffer of sixty-four characters\"}\n")
          == 0);
    (void)fclose(file);
    (void)close(made);
    (void)unlink(path);
    CHECK(pn_trace_open(&trace, "/dev/full", line, sizeof line));
    pn_trace_note(&trace, 1.0, "a name that is too long for a buffer of sixty-four characters", NULL);
    CHECK(!pn_trace_close(&trace)); /* a line that was cut is a failure, not half a line */
}

static int write_reprs(void)
{
    char line[64];
    char text[PN_REAL_TEXT_SIZE];
    while (fgets(line, sizeof line, stdin) != NULL) {
        const uint64_t bits = strtoull(line, NULL, 16);
        double value = 0.0;
        (void)memcpy(&value, &bits, sizeof value);
        (void)pn_real_repr(text, value);
        (void)puts(text);
    }
    return 0;
}

int main(int argc, char **argv)
{
    if ((argc == 2) && (strcmp(argv[1], "--repr") == 0)) {
        return write_reprs();
    }
    test_text();
    test_numbers();
    test_arena();
    test_moves();
    test_arrivals();
    test_colours_that_are_said();
    test_bytes();
    test_trace();
    (void)puts((s_failures == 0) ? "ok" : "failed");
    return (s_failures == 0) ? 0 : 1;
}
