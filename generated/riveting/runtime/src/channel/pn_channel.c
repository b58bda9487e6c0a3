/* SPDX-License-Identifier: MIT
 * pn_channel.c - the text form of messages (docs/protocol.md, "Format"), also used for input files.
 *
 * Reading is strict and written out by hand: strtod alone would take "0x1p3", "inf" and " 1". The program never calls
 * setlocale(), so numbers are those of the C locale.
 */
#include "pn/pn_channel.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define NUMBER_MAX 512U /* no number's text is as long: 1e308 with four decimals has 314 bytes */

static const char HEX[] = "0123456789abcdef";

static bool is_blank(char c)
{
    return (c == ' ') || (c == '\t') || (c == '\r');
}

static bool is_digit(char c)
{
    return (c >= '0') && (c <= '9');
}

uint32_t pn_crc32(uint32_t crc, const char *data, size_t length)
{
    /* Four bits at a time: sixteen words of table are enough for files of a line. */
    static const uint32_t table[16] = {
        0x00000000U, 0x1DB71064U, 0x3B6E20C8U, 0x26D930ACU, 0x76DC4190U, 0x6B6B51F4U, 0x4DB26158U, 0x5005713CU,
        0xEDB88320U, 0xF00F9344U, 0xD6D6A3E8U, 0xCB61B38CU, 0x9B64C2B0U, 0x86D3D2D4U, 0xA00AE278U, 0xBDBDF21CU,
    };
    uint32_t c = ~crc;
    for (size_t i = 0U; i < length; i++) {
        c ^= (uint32_t)(uint8_t)data[i];
        c = (c >> 4U) ^ table[c & 15U];
        c = (c >> 4U) ^ table[c & 15U];
    }
    return ~c;
}

const char *pn_quote(const char *data, size_t length, char *out, size_t capacity)
{
    size_t at = 0U;
    size_t i = 0U;
    out[at++] = '`';
    while ((i < length) && (i < 60U) && (at + 9U < capacity)) {
        const uint8_t c = (uint8_t)data[i];
        if (c == (uint8_t)'\n') {
            out[at++] = '\\';
            out[at++] = 'n';
        } else if ((c >= 0x20U) && (c < 0x7FU) && (c != (uint8_t)'`')) {
            out[at++] = (char)c;
        } else {
            out[at++] = '\\';
            out[at++] = 'x';
            out[at++] = HEX[c >> 4U];
            out[at++] = HEX[c & 15U];
        }
        i++;
    }
    out[at++] = '`';
    if (i < length) {
        (void)memcpy(out + at, "...", 3U);
        at += 3U;
    }
    out[at] = '\0';
    return out;
}

#ifdef PN_FLAT_TYPES /* no message has a list */
const pn_scalar_t *pn_scalar_next(pn_scalar_walk_t *walk)
{
    const uint32_t at = walk->next;
    walk->next += (at < walk->count) ? 1U : 0U;
    return (at < walk->count) ? &walk->scalar[at] : NULL;
}

void pn_scalar_is(pn_scalar_walk_t *walk, const pn_scalar_value_t *scalar_value)
{
    (void)walk;
    (void)scalar_value;
}

static uint32_t values_left(const pn_scalar_walk_t *walk)
{
    return walk->count - walk->next;
}
#else
const pn_scalar_t *pn_scalar_next(pn_scalar_walk_t *walk)
{
    if ((walk->left > 0U) && (walk->next == walk->end)) {
        walk->left--;
        walk->next = (walk->left > 0U) ? walk->first : walk->end;
    }
    const uint32_t at = walk->next;
    walk->next += (at < walk->count) ? 1U : 0U;
    return (at < walk->count) ? &walk->scalar[at] : NULL;
}

static void enter(pn_scalar_walk_t *walk, uint32_t length)
{
    const pn_scalar_t *const last = &walk->scalar[walk->next - 1U];
    if (last->kind == PN_SCALAR_LIST) {
        walk->first = walk->next;
        walk->end = walk->next + last->element_count;
        walk->left = length;
        walk->next = (length > 0U) ? walk->first : walk->end;
    }
}

void pn_scalar_is(pn_scalar_walk_t *walk, const pn_scalar_value_t *scalar_value)
{
    enter(walk, (uint32_t)scalar_value->integer);
}

/* How many values are still to come at least: other lists may be empty. */
static uint32_t values_left(const pn_scalar_walk_t *walk)
{
    pn_scalar_walk_t rest = *walk;
    uint32_t count = 0U;
    while (pn_scalar_next(&rest) != NULL) {
        enter(&rest, 0U);
        count++;
    }
    return count;
}
#endif

/* --- writing ------------------------------------------------------------------------------------------------------ */

/* With `digits` significant digits; whether that reads back to the same number. */
static bool real_digits(double value, int digits, char *text, size_t capacity)
{
    (void)snprintf(text, capacity, "%.*g", digits, value);
    return strtod(text, NULL) == value;
}

size_t pn_real_format(double value, char *out, size_t capacity)
{
    char text[512]; /* 1e308 with four decimals has 314 characters */
    if (!isfinite(value)) {
        return 0U;
    }
    /* A zero keeps its sign, which a net can see: what arrives is what was sent. */
    (void)snprintf(text, sizeof text, "%.4f", value);
    if (strtod(text, NULL) != value) {
        /* Most numbers that are not round need 15 to 17 digits; 17 always do. channels/scalars.py goes the same way. */
        int most = 15;
        while ((most < 17) && !real_digits(value, most, text, sizeof text)) {
            most++;
        }
        int least = (most == 15) ? 1 : most;
        while (least < most) {
            const int middle = (least + most) / 2;
            if (real_digits(value, middle, text, sizeof text)) {
                most = middle;
            } else {
                least = middle + 1;
            }
        }
        (void)snprintf(text, sizeof text, "%.*g", most, value);
    }
    const size_t length = strlen(text);
    if (length >= capacity) {
        return 0U;
    }
    (void)memcpy(out, text, length + 1U);
    return length;
}

/* `capacity` is at least 3: there is room for the quotes. */
static size_t string_format(const char *text, size_t length, char *out, size_t capacity)
{
    size_t at = 0U;
    out[at++] = '"';
    for (size_t i = 0U; i < length; i++) {
        const uint8_t c = (uint8_t)text[i];
        if (at + 6U > capacity) {
            return 0U;
        }
        if ((c == (uint8_t)'"') || (c == (uint8_t)'\\')) {
            out[at++] = '\\';
            out[at++] = (char)c;
        } else if ((c >= 0x20U) && (c < 0x7FU)) {
            out[at++] = (char)c;
        } else {
            out[at++] = '\\';
            out[at++] = 'x';
            out[at++] = HEX[c >> 4U];
            out[at++] = HEX[c & 15U];
        }
    }
    out[at++] = '"';
    out[at] = '\0';
    return at;
}

static size_t scalar_format(const pn_scalar_t *scalar, const pn_scalar_value_t *scalar_value, char *out,
                            size_t capacity)
{
    int length = 0;
    switch (scalar->kind) {
    case PN_SCALAR_UNIT: length = snprintf(out, capacity, "1"); break;
    case PN_SCALAR_BOOL: length = snprintf(out, capacity, "%d", (scalar_value->integer != 0) ? 1 : 0); break;
    case PN_SCALAR_INT:
    case PN_SCALAR_LIST:
    case PN_SCALAR_INDEX:
        if (!scalar->bounded || ((scalar_value->integer >= scalar->low) && (scalar_value->integer <= scalar->high))) {
            length = snprintf(out, capacity, "%" PRId64, scalar_value->integer);
        }
        break;
    case PN_SCALAR_ENUM:
        if ((uint64_t)scalar_value->integer < scalar->name_count) { /* a negative number is a large one here */
            length = snprintf(out, capacity, "%s", scalar->name[scalar_value->integer]);
        }
        break;
    case PN_SCALAR_REAL:
        if (!scalar->bounded
            || ((scalar_value->real >= scalar->real_low) && (scalar_value->real <= scalar->real_high))) {
            length = (int)pn_real_format(scalar_value->real, out, capacity);
        }
        break;
    case PN_SCALAR_STRING: length = (int)string_format(scalar_value->text, scalar_value->length, out, capacity); break;
    default: break;
    }
    return ((length > 0) && ((size_t)length < capacity)) ? (size_t)length : 0U;
}

size_t pn_scalars_format(const pn_scalar_t *scalar, uint32_t count, const pn_scalar_value_t *scalar_value, char *out,
                         size_t capacity)
{
    size_t at = 0U;
    pn_scalar_walk_t walk = { scalar, count, 0U, 0U, 0U, 0U };
    const pn_scalar_t *own = pn_scalar_next(&walk);
    uint32_t i = 0U;
    while (own != NULL) {
        if (at + 2U >= capacity) {
            return 0U;
        }
        if (i > 0U) {
            out[at++] = ' ';
        }
        const size_t length = scalar_format(own, &scalar_value[i], out + at, capacity - at);
        if (length == 0U) {
            return 0U;
        }
        pn_scalar_is(&walk, &scalar_value[i]);
        at += length;
        i++;
        own = pn_scalar_next(&walk);
    }
    return at;
}

/* The checksum covers "payload seq session", so that a payload cannot be paired with another message's trailer. */
static uint32_t seal(const char *payload, size_t length, uint64_t seq, const char *session)
{
    char tail[64];
    const int tail_length = snprintf(tail, sizeof tail, " %" PRIu64 " %s", seq, session);
    return pn_crc32(pn_crc32(0U, payload, length), tail, (size_t)tail_length);
}

size_t pn_channel_compose(const pn_cell_channel_t *channel, const pn_scalar_value_t *scalar_value, uint64_t seq,
                          const char *session, char *out, size_t capacity)
{
    const size_t payload = pn_scalars_format(channel->scalar, channel->scalar_count, scalar_value, out, capacity);
    if ((payload == 0U) || (payload > PN_CHANNEL_PAYLOAD)) {
        return 0U;
    }
    const uint32_t crc = seal(out, payload, seq, session);
    const int tail =
        snprintf(out + payload, capacity - payload, "\n# %" PRIu64 " %s %08" PRIx32 "\n", seq, session, crc);
    return ((size_t)tail < capacity - payload) ? payload + (size_t)tail : 0U; /* also 0 if it has failed: -1 */
}

/* --- reading ------------------------------------------------------------------------------------------------------ */

__attribute__((format(printf, 4, 5))) static void refuse(pn_message_t *out, pn_refusal_t refusal, size_t column,
                                                         const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    out->refusal = refusal;
    out->column = (uint32_t)column;
    (void)vsnprintf(out->report, sizeof out->report, format, arguments);
    va_end(arguments);
}

/* `[-+]digits[.digits][e[-+]digits]`, or, for an integer, only its first part. A word is never empty. */
static bool is_number(const char *word, size_t length, bool real)
{
    size_t i = 0U;
    size_t digits = 0U;
    if ((word[i] == '-') || (word[i] == '+')) {
        i++;
    }
    while ((i < length) && is_digit(word[i])) {
        i++;
        digits++;
    }
    if (real && (i < length) && (word[i] == '.')) {
        i++;
        while ((i < length) && is_digit(word[i])) {
            i++;
            digits++;
        }
    }
    if (real && (digits > 0U) && (i < length) && ((word[i] == 'e') || (word[i] == 'E'))) {
        i++;
        if ((i < length) && ((word[i] == '-') || (word[i] == '+'))) {
            i++;
        }
        const size_t first = i;
        while ((i < length) && is_digit(word[i])) {
            i++;
        }
        if (i == first) {
            return false;
        }
    }
    return (digits > 0U) && (i == length);
}

typedef struct pn_word {
    const char *text;
    size_t length;
    size_t column; /* 1-based */
} pn_word_t;

enum { NAMED_MAX = 256 };

/* A component with its colour set, for a refusal; a colour set whose name it has is named once. */
static const char *named(const pn_scalar_t *scalar, char name[NAMED_MAX])
{
    const bool is_one = strcmp(scalar->label, scalar->colset) == 0;
    (void)snprintf(name, NAMED_MAX, "%s%s%scolour set `%s`", is_one ? "" : "`", is_one ? "" : scalar->label,
                   is_one ? "" : "` of ", scalar->colset);
    return name;
}

/* Refuses a word: it, what is wrong, the component, and the rest of the sentence. */
static void refuse_word(pn_message_t *out, const pn_scalar_t *scalar, const pn_word_t *word, const char *wrong,
                        const char *rest)
{
    char shown[160];
    char name[NAMED_MAX];
    refuse(out, PN_REFUSAL_SCALAR, word->column, "%s %s%s%s", pn_quote(word->text, word->length, shown, sizeof shown),
           wrong, named(scalar, name), rest);
}

/* A number's word as a string; false if it is too long for one. */
static bool number_text(const pn_scalar_t *scalar, const pn_word_t *word, char *text, pn_message_t *out)
{
    if (word->length >= NUMBER_MAX) {
        refuse_word(out, scalar, word, "is too long for a number (", ")");
        return false;
    }
    (void)memcpy(text, word->text, word->length);
    text[word->length] = '\0';
    return true;
}

static bool integer_parse(const pn_scalar_t *scalar, const pn_word_t *word, pn_scalar_value_t *scalar_value,
                          pn_message_t *out)
{
    char name[NAMED_MAX];
    char text[NUMBER_MAX];
    if (!is_number(word->text, word->length, false)) {
        if (is_number(word->text, word->length, true)) {
            char shown[160];
            refuse(out, PN_REFUSAL_SCALAR, word->column, "found %s where %s should be an integer",
                   pn_quote(word->text, word->length, shown, sizeof shown), named(scalar, name));
        } else {
            refuse_word(out, scalar, word, "is not a number; ", " should be an integer");
        }
        return false;
    }
    if (!number_text(scalar, word, text, out)) {
        return false;
    }
    errno = 0;
    const long long value = strtoll(text, NULL, 10);
    if (errno == ERANGE) {
        refuse_word(out, scalar, word, "is too large for an integer (", ")");
        return false;
    }
    if (scalar->bounded && ((value < scalar->low) || (value > scalar->high))) {
        refuse(out, PN_REFUSAL_SCALAR, word->column, "%lld is outside %s, which goes from %" PRId64 " to %" PRId64,
               value, named(scalar, name), scalar->low, scalar->high);
        return false;
    }
    scalar_value->integer = (int64_t)value;
    return true;
}

#ifndef PN_FLAT_TYPES
/* How many elements a list has: decimal digits, as few as there can be. No message has as many as to need three. */
static bool length_parse(const pn_scalar_t *scalar, const pn_word_t *word, pn_scalar_value_t *scalar_value,
                         pn_message_t *out)
{
    bool good = (word->length <= 4U) && ((word->length == 1U) || (word->text[0] != '0'));
    for (size_t i = 0U; good && (i < word->length); i++) {
        const int digit = word->text[i] - '0';
        good = is_digit(word->text[i]);
        scalar_value->integer = (scalar_value->integer * 10) + (int64_t)digit;
    }
    if (!good || (scalar_value->integer < scalar->low) || (scalar_value->integer > scalar->high)) {
        refuse_word(out, scalar, word, "is no length of a list of ", "");
        return false;
    }
    return true;
}

#endif

static bool real_parse(const pn_scalar_t *scalar, const pn_word_t *word, pn_scalar_value_t *scalar_value,
                       pn_message_t *out)
{
    char shown[160];
    char name[NAMED_MAX];
    char text[NUMBER_MAX];
    if (!is_number(word->text, word->length, true)) {
        refuse_word(out, scalar, word, "is not a number; ", " should be a real number");
        return false;
    }
    if (!number_text(scalar, word, text, out)) {
        return false;
    }
    const double value = strtod(text, NULL);
    if (!isfinite(value)) {
        refuse_word(out, scalar, word, "is too large for a real number (", ")");
        return false;
    }
    if (scalar->bounded && ((value < scalar->real_low) || (value > scalar->real_high))) {
        refuse(out, PN_REFUSAL_SCALAR, word->column, "%s is outside %s, which goes from %g to %g",
               pn_quote(word->text, word->length, shown, sizeof shown), named(scalar, name), scalar->real_low,
               scalar->real_high);
        return false;
    }
    scalar_value->real = value;
    return true;
}

static bool enum_parse(const pn_scalar_t *scalar, const pn_word_t *word, pn_scalar_value_t *scalar_value,
                       pn_message_t *out)
{
    char shown[160];
    char name[NAMED_MAX];
    for (uint32_t i = 0U; i < scalar->name_count; i++) {
        if ((strlen(scalar->name[i]) == word->length) && (memcmp(scalar->name[i], word->text, word->length) == 0)) {
            scalar_value->integer = (int64_t)i;
            scalar_value->text = scalar->name[i];
            return true;
        }
    }
    refuse(out, PN_REFUSAL_SCALAR, word->column, "%s is not a value of %s; its first is `%s`",
           pn_quote(word->text, word->length, shown, sizeof shown), named(scalar, name), scalar->name[0]);
    return false;
}

static int hex_value(char c)
{
    const char *const at = (c != '\0') ? strchr(HEX, c) : NULL;
    const ptrdiff_t distance = (at != NULL) ? (at - HEX) : -1;
    return (int)distance;
}

/* Decodes a quoted string into the message's text. */
static bool string_parse(const pn_scalar_t *scalar, const pn_word_t *word, pn_scalar_value_t *scalar_value,
                         pn_message_t *out)
{
    bool good = (word->length >= 2U) && (word->text[0] == '"') && (word->text[word->length - 1U] == '"')
                && (out->text_length + word->length < sizeof out->text);
    size_t at = out->text_length;
    scalar_value->text = out->text + at;
    size_t i = 1U;
    while (good && (i + 1U < word->length)) {
        char c = word->text[i++];
        if (c == '\\') {
            const size_t left = word->length - 1U - i;
            if ((left >= 1U) && ((word->text[i] == '"') || (word->text[i] == '\\'))) {
                c = word->text[i++];
            } else if ((left >= 3U) && (word->text[i] == 'x') && (hex_value(word->text[i + 1U]) >= 0)
                       && (hex_value(word->text[i + 2U]) >= 0)) {
                const int code = (hex_value(word->text[i + 1U]) * 16) + hex_value(word->text[i + 2U]);
                c = (char)code;
                i += 3U;
            } else {
                good = false;
            }
        } else if (c == '"') {
            good = false; /* it has to be escaped */
        } else {
            /* a plain byte */
        }
        if (good) {
            out->text[at++] = c;
        }
    }
    if (!good) {
        refuse_word(out, scalar, word, "is not a string in double quotes (", ")");
        return false;
    }
    scalar_value->length = (uint32_t)(at - out->text_length);
    out->text[at++] = '\0';
    out->text_length = at;
    return true;
}

static bool scalar_parse(const pn_scalar_t *scalar, const pn_word_t *word, pn_scalar_value_t *scalar_value,
                         pn_message_t *out)
{
    static const char *const bool_name[2] = { "0", "1" };
    static const char *const unit_name[1] = { "1" };
    const pn_scalar_t bool_scalar = {
        .label = scalar->label, .colset = scalar->colset, .name_count = 2U, .name = bool_name
    };
    const pn_scalar_t unit_scalar = {
        .label = scalar->label, .colset = scalar->colset, .name_count = 1U, .name = unit_name
    };
    bool good = false;
    scalar_value->integer = 0;
    scalar_value->real = 0.0;
    scalar_value->text = NULL;
    scalar_value->length = 0U;
    switch (scalar->kind) {
    case PN_SCALAR_UNIT:
        scalar_value->kind = PN_VALUE_ENUM;
        good = enum_parse(&unit_scalar, word, scalar_value, out);
        scalar_value->text = (scalar->name_count > 0U) ? scalar->name[0] : "()";
        break;
    case PN_SCALAR_BOOL:
        scalar_value->kind = PN_VALUE_BOOL;
        good = enum_parse(&bool_scalar, word, scalar_value, out);
        break;
    case PN_SCALAR_INT:
        scalar_value->kind = PN_VALUE_INT;
        good = integer_parse(scalar, word, scalar_value, out);
        break;
#ifndef PN_FLAT_TYPES
    case PN_SCALAR_LIST:
        scalar_value->kind = PN_VALUE_LIST;
        good = length_parse(scalar, word, scalar_value, out);
        break;
#endif
    case PN_SCALAR_INDEX:
        scalar_value->kind = PN_VALUE_ENUM;
        good = integer_parse(scalar, word, scalar_value, out);
        break;
    case PN_SCALAR_REAL:
        scalar_value->kind = PN_VALUE_REAL;
        good = real_parse(scalar, word, scalar_value, out);
        break;
    case PN_SCALAR_STRING:
        scalar_value->kind = PN_VALUE_STRING;
        good = string_parse(scalar, word, scalar_value, out);
        break;
    case PN_SCALAR_ENUM:
        scalar_value->kind = PN_VALUE_ENUM;
        good = enum_parse(scalar, word, scalar_value, out);
        break;
#ifdef PN_FLAT_TYPES
    case PN_SCALAR_LIST:
#endif
    default: refuse(out, PN_REFUSAL_SCALAR, word->column, "unknown kind of scalar"); break;
    }
    return good;
}

/* The next word from `*at`; with `strings` blanks inside double quotes belong to it. False at the end of the line. */
static bool next_word(const char *line, size_t length, bool strings, size_t *at, pn_word_t *word)
{
    size_t i = *at;
    bool quoted = false;
    while ((i < length) && is_blank(line[i])) {
        i++;
    }
    word->text = line + i;
    word->column = i + 1U;
    const size_t first = i;
    while ((i < length) && (quoted || !is_blank(line[i]))) {
        if ((line[i] == '\\') && quoted && (i + 1U < length)) {
            i++;
        } else if (strings && (line[i] == '"')) {
            quoted = !quoted;
        } else {
            /* a plain byte */
        }
        i++;
    }
    word->length = i - first;
    *at = i;
    return i > first;
}

bool pn_scalars_parse(const pn_scalar_t *scalar, uint32_t count, const char *line, size_t length, pn_message_t *out)
{
    char shown[160];
    char name[NAMED_MAX];
    pn_word_t word = { line, 0U, 1U };
    pn_scalar_walk_t walk = { scalar, count, 0U, 0U, 0U, 0U };
    const pn_scalar_t *own = pn_scalar_next(&walk);
    size_t at = 0U;
    uint32_t i = 0U;
    while (next_word(line, length, true, &at, &word)) {
        if (own == NULL) {
            refuse(out, PN_REFUSAL_COUNT, word.column, "found %s after the %" PRIu32 " value%s that belong here",
                   pn_quote(word.text, word.length, shown, sizeof shown), i, (i == 1U) ? "" : "s");
            return false;
        }
        if (out->count >= PN_CHANNEL_SCALARS) {
            refuse(out, PN_REFUSAL_COUNT, word.column, "%s is one value too many",
                   pn_quote(word.text, word.length, shown, sizeof shown));
            return false;
        }
        pn_scalar_value_t *const value = &out->value[out->count];
        if (!scalar_parse(own, &word, value, out)) {
            return false;
        }
        pn_scalar_is(&walk, value);
#ifndef PN_FLAT_TYPES
        if ((value->kind == PN_VALUE_LIST) && (out->count + 1U + values_left(&walk) > PN_CHANNEL_SCALARS)) {
            refuse(out, PN_REFUSAL_COUNT, word.column, "%s makes more than the %u values that are possible",
                   pn_quote(word.text, word.length, shown, sizeof shown), PN_CHANNEL_SCALARS);
            return false;
        }
#endif
        out->column_of[out->count] = (uint32_t)word.column;
        out->count++;
        i++;
        own = pn_scalar_next(&walk);
    }
    if (own != NULL) {
        refuse(out, PN_REFUSAL_COUNT, length + 1U,
               "found %" PRIu32 " value%s where %" PRIu32 " are expected; the next would be %s", i,
               (i == 1U) ? "" : "s", i + 1U + values_left(&walk), named(own, name));
        return false;
    }
    return true;
}

/* Line 2, `# seq session crc`, against the payload. */
static bool trailer_parse(const char *payload, size_t payload_length, const char *line, size_t length,
                          const char *session, pn_message_t *out)
{
    char shown[160];
    char found_session[PN_CHANNEL_SESSION];
    pn_word_t hash;
    pn_word_t seq;
    pn_word_t run;
    pn_word_t crc;
    pn_word_t more;
    size_t at = 0U;
    const bool shaped = next_word(line, length, false, &at, &hash) && next_word(line, length, false, &at, &seq)
                        && next_word(line, length, false, &at, &run) && next_word(line, length, false, &at, &crc)
                        && !next_word(line, length, false, &at, &more) && (hash.length == 1U) && (line[0] == '#')
                        && (seq.length <= 18U) && is_digit(seq.text[0]) && is_number(seq.text, seq.length, false)
                        && (run.length < sizeof found_session) && (crc.length == 8U);
    uint32_t found_crc = 0U;
    bool hexadecimal = shaped;
    for (size_t i = 0U; hexadecimal && (i < 8U); i++) {
        const int digit = hex_value(crc.text[i]);
        hexadecimal = (digit >= 0);
        found_crc = (found_crc << 4U) | (uint32_t)(hexadecimal ? digit : 0);
    }
    if (!hexadecimal) {
        refuse(out, PN_REFUSAL_TRAILER, 1U, "line 2 is %s where `# seq session checksum` is expected",
               pn_quote(line, length, shown, sizeof shown));
        return false;
    }
    (void)memcpy(found_session, run.text, run.length);
    found_session[run.length] = '\0';
    for (size_t i = 0U; i < seq.length; i++) {
        const int digit = seq.text[i] - '0';
        out->seq = (out->seq * 10U) + (uint64_t)digit;
    }
    out->sealed = true;
    const uint32_t expected = seal(payload, payload_length, out->seq, found_session);
    if (expected != found_crc) {
        refuse(out, PN_REFUSAL_CHECKSUM, 1U,
               "checksum %08" PRIx32 " where %08" PRIx32 " is expected: %s is torn or altered", found_crc, expected,
               pn_quote(payload, payload_length, shown, sizeof shown));
        return false;
    }
    if (strcmp(found_session, session) != 0) {
        refuse(out, PN_REFUSAL_SESSION, 1U, "a message of session %s where %s is running", found_session, session);
        return false;
    }
    return true;
}

/* Length of the line at the beginning of the text, without its end. */
static size_t line_length(const char *text, size_t length)
{
    const char *const end = memchr(text, '\n', length);
    const ptrdiff_t distance = (end != NULL) ? (end - text) : 0;
    size_t n = (end != NULL) ? (size_t)distance : length;
    return n;
}

static size_t trimmed(const char *line, size_t length)
{
    size_t n = length;
    while ((n > 0U) && is_blank(line[n - 1U])) {
        n--;
    }
    return n;
}

bool pn_channel_is_empty(const char *text, size_t length)
{
    const size_t first = line_length(text, length);
    const size_t rest = (first < length) ? first + 1U : length;
    const bool is_last = (rest == length) || ((rest + 1U == length) && (text[rest] == '\n'));
    return is_last && (trimmed(text, first) == 1U) && (text[0] == '0');
}

pn_channel_state_t pn_channel_parse(const pn_cell_channel_t *channel, const char *text, size_t length,
                                    const char *session, uint64_t consumed, pn_message_t *out)
{
    char shown[160];
    out->count = 0U;
    out->sealed = false;
    out->seq = 0U;
    out->refusal = PN_REFUSAL_NONE;
    out->column = 0U;
    out->report[0] = '\0';
    out->text_length = 0U;
    if ((length >= PN_CHANNEL_TEXT) || (memchr(text, '\0', length) != NULL)) {
        refuse(out, PN_REFUSAL_SHAPE, 1U, "found %s, %s", pn_quote(text, length, shown, sizeof shown),
               (length >= PN_CHANNEL_TEXT) ? "longer than any message" : "with a zero byte in it");
        return PN_CHANNEL_REFUSED;
    }
    const size_t first = line_length(text, length);
    const size_t payload = trimmed(text, first);
    if (payload == 0U) {
        refuse(out, PN_REFUSAL_SHAPE, 1U, "found an empty line where a message, or `0` for none, is expected");
        return PN_CHANNEL_REFUSED;
    }
    const size_t rest = (first < length) ? first + 1U : length;
    const size_t second = line_length(text + rest, length - rest);
    const size_t trailer = trimmed(text + rest, second);
    const size_t after = (rest + second < length) ? rest + second + 1U : length;
    if ((after < length) || ((trailer == 0U) && (second > 0U))) {
        refuse(out, PN_REFUSAL_SHAPE, 1U, "found more than two lines, or a blank second one: %s",
               pn_quote(text, length, shown, sizeof shown));
        return PN_CHANNEL_REFUSED;
    }
    if ((trailer > 0U) && !trailer_parse(text, payload, text + rest, trailer, session, out)) {
        return PN_CHANNEL_REFUSED;
    }
    if (pn_channel_is_empty(text, length)) {
        return PN_CHANNEL_EMPTY;
    }
    if (!pn_scalars_parse(channel->scalar, channel->scalar_count, text, payload, out)) {
        return PN_CHANNEL_REFUSED;
    }
    if (out->sealed && (out->seq <= consumed)) {
        refuse(out, PN_REFUSAL_REPEATED, 1U, "message %" PRIu64 " again, which has been consumed", out->seq);
        return PN_CHANNEL_REFUSED;
    }
    if (out->sealed && (out->seq != consumed + 1U)) {
        refuse(out, PN_REFUSAL_LOST, 1U, "message %" PRIu64 " where %" PRIu64 " is expected: one has been lost",
               out->seq, consumed + 1U);
        return PN_CHANNEL_REFUSED;
    }
    return PN_CHANNEL_MESSAGE;
}
