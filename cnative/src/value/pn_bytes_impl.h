/* SPDX-License-Identifier: MIT
 * pn_bytes_impl.h - numbers as few bytes, for canonical bytes: each number has exactly one form. Package-private.
 *
 *     number without a sign   seven bits a byte, the lowest first; the highest bit says that there are more
 *     integer                 the same for 0, -1, 1, -2, 2, ..., numbered from 0
 *     eight bytes of a real   how many bytes of its highest bits are there (the others are 0), and these, the lowest
 *                             first
 */
#ifndef PN_BYTES_IMPL_H
#define PN_BYTES_IMPL_H

#include <math.h>
#include <string.h>

#include "pn/pn_types.h"

#define PN_NUMBER_MOST 10U /* bytes of a number */

/* Appended if there is room; returns the end in any case. */
static inline size_t put_bytes(uint8_t *out, size_t room, size_t at, const void *bytes, size_t length)
{
    if ((length > 0U) && (at <= room) && (length <= (room - at))) {
        (void)memcpy(&out[at], bytes, length);
    }
    return at + length;
}

static inline size_t put_number(uint8_t *out, size_t room, size_t at, uint64_t number)
{
    if ((number < 0x80U) && (at < room)) {
        out[at] = (uint8_t)number;
        return at + 1U;
    }
    uint8_t bytes[PN_NUMBER_MOST];
    size_t length = 0U;
    for (; number >= 0x80U; number >>= 7U) {
        bytes[length++] = (uint8_t)(0x80U | (number & 0x7fU));
    }
    bytes[length++] = (uint8_t)number;
    return put_bytes(out, room, at, bytes, length);
}

static inline size_t put_integer(uint8_t *out, size_t room, size_t at, int64_t value)
{
    const uint64_t sign = (value < 0) ? UINT64_MAX : 0U;
    return put_number(out, room, at, ((uint64_t)value << 1U) ^ sign);
}

/*
 * Reals that no expression can tell apart have the same bytes: all that are not a number. The two zeros are equal, but
 * have their own: a net may see the sign (`Real.signBit`, `1.0 / x`), and two markings that it can tell apart are two.
 */
static inline size_t put_real(uint8_t *out, size_t room, size_t at, double value)
{
    const double known = isnan(value) ? (double)NAN : value;
    uint64_t bits = 0U;
    (void)memcpy(&bits, &known, sizeof bits);
    uint8_t bytes[1U + sizeof bits] = { 0U };
    for (; (bits != 0U) && ((bits & 0xffU) == 0U); bits >>= 8U) {
        bytes[0]++; /* those that are left out */
    }
    bytes[0] = (bits == 0U) ? 0U : (uint8_t)(sizeof bits - bytes[0]);
    for (uint32_t i = 1U; i <= bytes[0]; i++) {
        bytes[i] = (uint8_t)(bits >> (8U * (i - 1U)));
    }
    return put_bytes(out, room, at, bytes, 1U + (size_t)bytes[0]);
}

/* What begins at *at, which moves behind it. False: it is malformed, or not all there; *at is undefined then. */
static inline bool get_number(const uint8_t *in, size_t length, size_t *at, uint64_t *number)
{
    uint64_t found = 0U;
    uint32_t shift = 0U;
    uint8_t byte = 0x80U;
    while ((byte >= 0x80U) && (*at < length) && (shift < 64U)) {
        byte = in[*at];
        *at += 1U;
        found |= (uint64_t)(byte & 0x7fU) << shift;
        shift += 7U;
    }
    *number = found;
    const bool is_shortest = (byte != 0U) || (shift == 7U);
    const bool is_lost = (shift > 63U) && (byte > 1U); /* bits beyond the last */
    return (byte < 0x80U) && is_shortest && !is_lost;
}

static inline bool get_integer(const uint8_t *in, size_t length, size_t *at, int64_t *value)
{
    uint64_t number = 0U;
    const bool is_fine = get_number(in, length, at, &number);
    const uint64_t sign = ((number & 1U) != 0U) ? UINT64_MAX : 0U;
    const uint64_t bits = (number >> 1U) ^ sign;
    (void)memcpy(value, &bits, sizeof bits);
    return is_fine;
}

static inline bool get_real(const uint8_t *in, size_t length, size_t *at, double *value)
{
    uint64_t bits = 0U;
    const uint8_t count = (*at < length) ? in[*at] : UINT8_MAX;
    const bool is_fine = (count <= sizeof bits) && (count < (length - *at)) && ((count == 0U) || (in[*at + 1U] != 0U));
    *at += 1U;
    for (uint32_t i = 0U; is_fine && (i < count); i++) {
        bits |= (uint64_t)in[*at] << (8U * (sizeof bits - count + i));
        *at += 1U;
    }
    (void)memcpy(value, &bits, sizeof bits);
    return is_fine;
}

#endif /* PN_BYTES_IMPL_H */
