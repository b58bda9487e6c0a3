/* SPDX-License-Identifier: MIT */
#include "pn/explore_tokens.h"

#include <string.h>

#include "pn/pn_packed.h"
#include "../../marking/pn_multiset_impl.h"
#include "../../value/pn_type_impl.h"

/* Lists grow at their front, so both ways go through the tokens from behind. */

static const void *packed_tokens(pn_ctx_t *cx, const pn_multiset_t *multiset, const pn_type_t *list,
                                 const void *marking)
{
    const void *found = NULL;
    for (uint32_t i = multiset->colours; i > 0U; i--) {
        const uint32_t count = pn_counter(marking, multiset->bit, multiset->width, i - 1U);
        for (uint32_t k = 0U; k < count; k++) {
            void *const cell = pn_list_new(cx, list, found);
            if (cell == NULL) {
                return NULL;
            }
            multiset->colour_of(i - 1U, pn_list_slot(list, cell));
            found = cell;
        }
    }
    return found;
}

/* A colour, with its stamp if it is timed. */
static void fill(const pn_multiset_t *multiset, const pn_type_t *list, void *slot, const void *entry)
{
    const void *const value = part(entry, multiset->value);
    if (!multiset->is_timed) {
        (void)memcpy(slot, value, multiset->type->size);
        return;
    }
    const pn_field_t *const field = list->element->field;
    const pn_time_t stamp = pn_multiset_stamp_of(multiset, entry);
    (void)memcpy(part_of(slot, field[0].offset), value, multiset->type->size);
    (void)memcpy(part_of(slot, field[1].offset), &stamp, sizeof stamp);
}

const void *explore_tokens(pn_ctx_t *cx, const pn_multiset_t *multiset, const pn_type_t *list, const void *marking)
{
    if (multiset->is_packed) {
        return packed_tokens(cx, multiset, list, marking);
    }
    const void *found = NULL;
    for (uint32_t i = pn_multiset_used(multiset, marking); i > 0U; i--) {
        const void *const entry = pn_multiset_entry(multiset, marking, i - 1U);
        const uint32_t count = pn_multiset_count_of(multiset, entry);
        for (uint32_t k = 0U; k < count; k++) {
            void *const cell = pn_list_new(cx, list, found);
            if (cell == NULL) {
                return NULL;
            }
            fill(multiset, list, pn_list_slot(list, cell), entry);
            found = cell;
        }
    }
    return found;
}
