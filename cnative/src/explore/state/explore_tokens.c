/* SPDX-License-Identifier: MIT */
#include "pn/explore_tokens.h"

#include <string.h>

#include "pn/pn_packed.h"
#include "../../marking/pn_bag_impl.h"
#include "../../value/pn_type_impl.h"

/* Lists grow at their front, so both ways go through the tokens from behind. */

static const void *packed_tokens(pn_ctx_t *cx, const pn_bag_t *bag, const pn_type_t *list, const void *marking)
{
    const void *found = NULL;
    for (uint32_t i = bag->colours; i > 0U; i--) {
        const uint32_t count = pn_counter(marking, bag->bit, bag->width, i - 1U);
        for (uint32_t k = 0U; k < count; k++) {
            void *const cell = pn_list_new(cx, list, found);
            if (cell == NULL) {
                return NULL;
            }
            bag->colour_of(i - 1U, pn_list_slot(list, cell));
            found = cell;
        }
    }
    return found;
}

/* A colour, with its stamp if it is timed. */
static void fill(const pn_bag_t *bag, const pn_type_t *list, void *slot, const void *entry)
{
    const void *const value = part(entry, bag->value);
    if (!bag->is_timed) {
        (void)memcpy(slot, value, bag->type->size);
        return;
    }
    const pn_field_t *const field = list->element->field;
    const pn_time_t stamp = pn_bag_stamp_of(bag, entry);
    (void)memcpy(part_of(slot, field[0].offset), value, bag->type->size);
    (void)memcpy(part_of(slot, field[1].offset), &stamp, sizeof stamp);
}

const void *explore_tokens(pn_ctx_t *cx, const pn_bag_t *bag, const pn_type_t *list, const void *marking)
{
    if (bag->is_packed) {
        return packed_tokens(cx, bag, list, marking);
    }
    const void *found = NULL;
    for (uint32_t i = pn_bag_used(bag, marking); i > 0U; i--) {
        const void *const entry = pn_bag_entry(bag, marking, i - 1U);
        const uint32_t count = pn_bag_count_of(bag, entry);
        for (uint32_t k = 0U; k < count; k++) {
            void *const cell = pn_list_new(cx, list, found);
            if (cell == NULL) {
                return NULL;
            }
            fill(bag, list, pn_list_slot(list, cell), entry);
            found = cell;
        }
    }
    return found;
}
