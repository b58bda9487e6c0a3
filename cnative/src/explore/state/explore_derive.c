/* SPDX-License-Identifier: MIT
 * explore_derive.c - packed places that follow from others: the net proves that a sum of markings never changes, so one
 * of the places of the sum is no part of a vector. What the sum is, the initial marking says.
 */
#include "../explore_run.h"

enum { UNIT_BITS = 64 };

/* The counters of a place within one unit. */
static ex_term_t term_of(const pn_place_t *place, uint32_t piece, uint32_t weight)
{
    const uint32_t bits = place->multiset->colours * place->multiset->width;
    const uint32_t from = place->multiset->bit + (piece * (uint32_t)UNIT_BITS);
    const uint32_t left = bits - (piece * (uint32_t)UNIT_BITS);
    return (ex_term_t){ .unit = from / (uint32_t)UNIT_BITS,
                        .shift = from % (uint32_t)UNIT_BITS,
                        .mask = (left < (uint32_t)UNIT_BITS) ? (((uint64_t)1U << left) - 1U) : UINT64_MAX,
                        .weight = weight };
}

/* Large places begin with a unit, small ones lie in one. */
static uint32_t pieces_of(const pn_place_t *place)
{
    return ((place->multiset->colours * place->multiset->width) + (uint32_t)UNIT_BITS - 1U) / (uint32_t)UNIT_BITS;
}

bool ex_derived_make(ex_run_t *run)
{
    ex_codec_t *const codec = run->codec;
    uint64_t pieces = 0U;
    uint64_t terms = 0U;
    for (uint32_t p = 0U; p < pn_net.place_count; p++) {
        const pn_place_t *const place = &pn_net.place[p];
        pieces += (place->share_count > 0U) ? pieces_of(place) : 0U;
        terms += (uint64_t)place->share_count * pieces_of(place);
    }
    codec->derived = ex_table(&run->memory, pieces, sizeof *codec->derived);
    codec->term = ex_table(&run->memory, terms, sizeof *codec->term);
    if ((codec->derived == NULL) || (codec->term == NULL)) {
        return false;
    }
    uint32_t used = 0U;
    for (uint32_t p = 0U; !codec->is_whole && (p < pn_net.place_count); p++) {
        const pn_place_t *const place = &pn_net.place[p];
        for (uint32_t piece = 0U; (place->share_count > 0U) && (piece < pieces_of(place)); piece++) {
            codec->derived[codec->derived_count] =
                (ex_derived_t){ .of = term_of(place, piece, 1U), .first = used, .terms = place->share_count };
            codec->derived_count++;
            for (uint32_t k = 0U; k < place->share_count; k++) {
                codec->term[used] = term_of(&pn_net.place[place->share[k].place], piece, place->share[k].weight);
                used++;
            }
        }
    }
    return true;
}

void ex_derived_start(ex_run_t *run, const void *initial)
{
    ex_codec_t *const codec = run->codec;
    const uint64_t *const unit = initial;
    for (uint32_t i = 0U; i < codec->derived_count; i++) {
        ex_derived_t *const derived = &codec->derived[i];
        derived->constant = (unit[derived->of.unit] >> derived->of.shift) & derived->of.mask;
        for (uint32_t k = 0U; k < derived->terms; k++) {
            const ex_term_t *const term = &codec->term[derived->first + k];
            derived->constant += term->weight * ((unit[term->unit] >> term->shift) & term->mask);
        }
    }
}
