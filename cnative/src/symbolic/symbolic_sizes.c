/* SPDX-License-Identifier: MIT
 * symbolic_sizes.c - how large a set is: exact numbers of any length, sums along the longest path.
 *
 *     sizes MARKINGS ARCS TOKENS-IN-A-PLACE TOKENS-IN-A-MARKING
 *
 * A number is an array of words, the lowest first, of a length that is worked out before: all numbers are modulo a
 * power of two that the results do not reach.
 */
#include "symbolic.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { WORD_BITS = 64, DIGITS = 9 };

/* --- a set as an array -------------------------------------------------------------------------------------------- */

typedef struct marks {
    uint64_t *bit;    /* index in the pool -> whether the node is in the set */
    uint32_t *before; /* word of `bit` -> nodes before it */
    uint64_t words;
} marks_t;

/* The unit is node 0. */
static uint32_t dense(const marks_t *m, sy_node_t n)
{
    const uint64_t lower = m->bit[n / WORD_BITS] & ((1ULL << (n % WORD_BITS)) - 1U);
    return m->before[n / WORD_BITS] + (uint32_t)__builtin_popcountll(lower);
}

/* Children lie before their parents in the pool: one walk from the root down finds all. */
static void mark(const sy_diagrams_t *d, sy_node_t root, marks_t *m)
{
    m->bit[root / WORD_BITS] |= 1ULL << (root % WORD_BITS);
    for (uint64_t w = m->words; w > 0U; w--) {
        uint64_t done = 0U;
        while ((m->bit[w - 1U] & ~done) != 0U) { /* children in the same word may join */
            const uint64_t open = m->bit[w - 1U] & ~done;
            const uint32_t top = (uint32_t)WORD_BITS - 1U - (uint32_t)__builtin_clzll(open);
            const sy_node_t n = (sy_node_t)(((w - 1U) * (uint64_t)WORD_BITS) + top);
            done |= 1ULL << top;
            for (uint32_t i = 0U; (n != (sy_node_t)SY_UNIT) && (i < sy_count(d, n)); i++) {
                const sy_node_t child = sy_child(d, n, i);
                m->bit[child / WORD_BITS] |= 1ULL << (child % WORD_BITS);
            }
        }
    }
    for (uint64_t w = 0U; w < m->words; w++) {
        m->before[w + 1U] = m->before[w] + (uint32_t)__builtin_popcountll(m->bit[w]);
    }
}

static void fill(const sy_diagrams_t *d, const marks_t *m, sy_frozen_t *f)
{
    uint32_t i = 1U;
    uint64_t edge = 0U;
    for (uint64_t w = 0U; w < m->words; w++) {
        for (uint64_t left = m->bit[w]; left != 0U; left &= left - 1U) {
            const sy_node_t n = (sy_node_t)((w * (uint64_t)WORD_BITS) + (uint64_t)__builtin_ctzll(left));
            if (n == (sy_node_t)SY_UNIT) {
                continue;
            }
            f->level[i] = sy_level(d, n);
            f->first[i] = edge;
            for (uint32_t k = 0U; k < sy_count(d, n); k++) {
                f->tokens[edge] = sy_tokens(d, n, k);
                f->child[edge] = dense(m, sy_child(d, n, k));
                edge++;
            }
            i++;
        }
    }
    f->first[i] = edge;
}

static void sort_by_level(sy_frozen_t *f, uint32_t levels)
{
    for (uint32_t i = 0U; i < f->nodes; i++) {
        f->levels[f->level[i] + 2U]++;
    }
    for (uint32_t l = 0U; l <= levels; l++) {
        f->levels[l + 2U] += f->levels[l + 1U];
    }
    for (uint32_t i = 0U; i < f->nodes; i++) {
        f->at[f->levels[f->level[i] + 1U]] = i;
        f->levels[f->level[i] + 1U]++;
    }
}

void sy_freeze(sy_diagrams_t *d, sy_node_t n, sy_frozen_t *f)
{
    marks_t m = { NULL, NULL, ((uint64_t)n / WORD_BITS) + 1U };
    m.bit = tb_new(m.words, sizeof *m.bit);
    m.before = tb_new(m.words + 1U, sizeof *m.before);
    m.bit[0] |= 1ULL << (uint32_t)SY_UNIT;
    mark(d, n, &m);
    f->nodes = m.before[m.words];
    f->all_edges = 0U;
    for (uint64_t w = 0U; w < m.words; w++) {
        for (uint64_t left = m.bit[w]; left != 0U; left &= left - 1U) {
            const sy_node_t k = (sy_node_t)((w * (uint64_t)WORD_BITS) + (uint64_t)__builtin_ctzll(left));
            f->all_edges += (k == (sy_node_t)SY_UNIT) ? 0U : sy_count(d, k);
        }
    }
    f->level = tb_new(f->nodes, sizeof *f->level);
    f->first = tb_new((size_t)f->nodes + 1U, sizeof *f->first);
    f->tokens = tb_new(f->all_edges, sizeof *f->tokens);
    f->child = tb_new(f->all_edges, sizeof *f->child);
    f->at = tb_new(f->nodes, sizeof *f->at);
    f->levels = tb_new((size_t)d->levels + 3U, sizeof *f->levels);
    fill(d, &m, f);
    sort_by_level(f, d->levels);
    tb_free(m.bit, m.words, sizeof *m.bit);
    tb_free(m.before, m.words + 1U, sizeof *m.before);
}

void sy_unfreeze(const sy_diagrams_t *d, sy_frozen_t *f)
{
    tb_free(f->level, f->nodes, sizeof *f->level);
    tb_free(f->first, (size_t)f->nodes + 1U, sizeof *f->first);
    tb_free(f->tokens, f->all_edges, sizeof *f->tokens);
    tb_free(f->child, f->all_edges, sizeof *f->child);
    tb_free(f->at, f->nodes, sizeof *f->at);
    tb_free(f->levels, (size_t)d->levels + 3U, sizeof *f->levels);
}

/* --- sums --------------------------------------------------------------------------------------------------------- */

/* By level a factor, or what each value adds. */
typedef struct factors {
    const int64_t *factor;
    int64_t **added; /* NULL: there are factors only */
} factors_t;

static bool product_of(const factors_t *f, uint32_t level, tb_count_t tokens, int64_t *product)
{
    if ((f->added != NULL) && (f->added[level] != NULL)) {
        *product = f->added[level][tokens];
        return true;
    }
    return !__builtin_mul_overflow(f->factor[level], (int64_t)tokens, product);
}

static bool largest(const sy_frozen_t *f, const factors_t *of, int64_t *sum)
{
    int64_t *best = tb_new(f->nodes, sizeof *best);
    bool is_small = true;
    for (uint32_t i = 1U; is_small && (i < f->nodes); i++) {
        best[i] = INT64_MIN;
        for (uint64_t e = f->first[i]; e < f->first[i + 1U]; e++) {
            int64_t all;
            is_small = is_small && product_of(of, f->level[i], f->tokens[e], &all)
                       && !__builtin_add_overflow(all, best[f->child[e]], &all);
            best[i] = (is_small && (all > best[i])) ? all : best[i];
        }
    }
    *sum = best[f->nodes - 1U];
    tb_free(best, f->nodes, sizeof *best);
    return is_small;
}

bool sy_largest(const sy_frozen_t *f, const int64_t *factor, int64_t *sum)
{
    const factors_t of = { factor, NULL };
    return largest(f, &of, sum);
}

/* The terms of an exact place are for its values, one after the other. */
bool sy_largest_of(const sy_diagrams_t *d, const sy_frozen_t *f, const tb_formula_t *sum, int64_t *most)
{
    const size_t levels = (size_t)d->levels + 1U;
    int64_t *factor = tb_new(levels, sizeof *factor);
    int64_t **added = tb_new(levels, sizeof *added);
    uint32_t *terms = tb_new(levels, sizeof *terms);
    for (uint32_t i = 0U; i < sum->count; i++) {
        const uint32_t level = d->level[sum->term[i].place];
        const uint32_t *exact = sy_exact(d, level);
        if (exact == NULL) {
            factor[level] += sum->term[i].factor;
        } else {
            added[level] = (added[level] != NULL) ? added[level] : tb_new((size_t)exact[0] + 1U, sizeof **added);
            terms[level] += (terms[level] < exact[0]) ? 1U : 0U;
            added[level][terms[level]] = sum->term[i].factor;
        }
    }
    const factors_t of = { factor, added };
    const bool is_small = largest(f, &of, most);
    for (uint32_t level = 1U; level <= d->levels; level++) {
        const uint32_t *exact = sy_exact(d, level);
        tb_free(added[level], (exact != NULL) ? ((size_t)exact[0] + 1U) : 0U, sizeof **added);
    }
    tb_free(factor, levels, sizeof *factor);
    tb_free(added, levels, sizeof *added);
    tb_free(terms, levels, sizeof *terms);
    return is_small;
}

/* --- numbers of any length ---------------------------------------------------------------------------------------- */

static void plus(uint64_t *a, const uint64_t *b, uint32_t words)
{
    uint64_t carry = 0U;
    for (uint32_t i = 0U; i < words; i++) {
        const uint64_t with_carry = a[i] + carry;
        carry = (with_carry < carry) ? 1U : 0U;
        a[i] = with_carry + b[i];
        carry += (a[i] < with_carry) ? 1U : 0U;
    }
}

/* a += b * c */
static void plus_product(uint64_t *a, const uint64_t *b, const uint64_t *c, uint32_t words)
{
    for (uint32_t i = 0U; i < words; i++) {
        uint64_t carry = 0U;
        for (uint32_t k = 0U; (b[i] != 0U) && (k < (words - i)); k++) {
            __extension__ const unsigned __int128 p = ((unsigned __int128)b[i] * c[k]) + a[i + k] + carry;
            a[i + k] = (uint64_t)p;
            carry = (uint64_t)(p >> (uint32_t)WORD_BITS);
        }
    }
}

/* Print a number, which is lost. */
static void print(uint64_t *a, uint32_t words)
{
    const uint64_t base = 1000000000U;
    uint32_t *part = tb_new(((size_t)words * 3U) + 1U, sizeof *part);
    uint32_t parts = 0U;
    uint32_t top = words;
    while (top > 0U) {
        if (a[top - 1U] == 0U) {
            top--;
            continue;
        }
        uint64_t rest = 0U;
        for (uint32_t i = top; i > 0U; i--) {
            __extension__ const unsigned __int128 n = ((unsigned __int128)rest << (uint32_t)WORD_BITS) | a[i - 1U];
            a[i - 1U] = (uint64_t)(n / base);
            rest = (uint64_t)(n % base);
        }
        part[parts] = (uint32_t)rest;
        parts++;
    }
    (void)printf(" %" PRIu32, (parts > 0U) ? part[parts - 1U] : 0U);
    for (uint32_t i = parts; i > 1U; i--) {
        (void)printf("%0*" PRIu32, (int)DIGITS, part[i - 2U]);
    }
    tb_free(part, ((size_t)words * 3U) + 1U, sizeof *part);
}

/* --- ways to divide tokens among leaves --------------------------------------------------------------------------- */

/* The ways to divide up to so many tokens among a number of leaves. */
typedef struct ways {
    uint32_t leaves; /* 1: there is one way, and no table */
    tb_count_t most;
    uint64_t *table; /* tokens -> ways, a number each */
    struct ways *next;
} ways_t;

static double log2_of_ways(uint32_t leaves, tb_count_t tokens)
{
    if ((leaves == 1U) || (tokens == 0U)) {
        return 0.0;
    }
    const double n = (double)leaves;
    const double k = (double)tokens;
    const double nats = lgamma(k + n) - lgamma(k + 1.0) - lgamma(n);
    return ((nats / log(2.0)) + (1e-9 * (k + n) * log2(k + n))) + 1e-6; /* rounded up */
}

/* With one leaf more the ways are the sums of those with fewer tokens. */
static void tabulate(ways_t *w, uint32_t words)
{
    w->table = tb_new(((size_t)w->most + 1U) * words, sizeof *w->table);
    for (tb_count_t k = 0U; k <= w->most; k++) {
        w->table[(size_t)k * words] = 1U;
    }
    for (uint32_t n = 1U; n < w->leaves; n++) {
        for (tb_count_t k = 1U; k <= w->most; k++) {
            plus(&w->table[(size_t)k * words], &w->table[(size_t)(k - 1U) * words], words);
        }
        if (tb_is_over()) {
            tb_fail(TB_EXIT_TIME, "time is over");
        }
    }
}

/* --- counting ----------------------------------------------------------------------------------------------------- */

typedef struct counting {
    const sy_diagrams_t *d;
    const sy_frozen_t *f;
    const ways_t **ways; /* level -> how tokens are divided there */
    ways_t *all_ways;
    uint32_t words;    /* of a number */
    uint64_t *below;   /* node -> markings from there downwards */
    uint64_t *above;   /* node -> ways from the root to it */
    uint64_t *enabled; /* node -> markings from there downwards that enable the transition `of` */
    uint32_t *of;      /* node -> transition + 1 */
    uint64_t *zero;
} counting_t;

static uint32_t leaves_at(const sy_diagrams_t *d, const tb_job_t *job, uint32_t level)
{
    return ((job->leaves != NULL) && (level > 0U)) ? job->leaves[d->place[level]] : 1U;
}

/* How many bits the number of markings has at most: sums of numbers with exponents of their own, rounded up. */
static double bits(const sy_diagrams_t *d, const sy_frozen_t *f, const tb_job_t *job)
{
    double *exponent = tb_new(f->nodes, sizeof *exponent);
    double *of_edge = tb_new(f->all_edges, sizeof *of_edge);
    for (uint32_t i = 1U; i < f->nodes; i++) {
        double most = 0.0;
        double sum = 0.0;
        for (uint64_t e = f->first[i]; e < f->first[i + 1U]; e++) {
            const uint32_t *exact = sy_exact(d, f->level[i]);
            const double ways = (exact != NULL) ? log2((double)((f->tokens[e] > 0U) ? exact[f->tokens[e]] : 1U))
                                                : log2_of_ways(leaves_at(d, job, f->level[i]), f->tokens[e]);
            of_edge[e] = exponent[f->child[e]] + ways;
            most = (of_edge[e] > most) ? of_edge[e] : most;
        }
        for (uint64_t e = f->first[i]; e < f->first[i + 1U]; e++) {
            sum += exp2(of_edge[e] - most);
        }
        exponent[i] = (most + log2(sum)) * (1.0 + 1e-15) + 1e-12;
    }
    const double found = exponent[f->nodes - 1U];
    tb_free(exponent, f->nodes, sizeof *exponent);
    tb_free(of_edge, f->all_edges, sizeof *of_edge);
    return found;
}

/* Levels with as many leaves have a table in common. */
static void find_ways(counting_t *c, const tb_job_t *job)
{
    const sy_diagrams_t *d = c->d;
    c->ways = tb_new((size_t)d->levels + 1U, sizeof(ways_t *));
    for (uint32_t level = 1U; level <= d->levels; level++) {
        const uint32_t leaves = leaves_at(d, job, level);
        ways_t *w = c->all_ways;
        while ((w != NULL) && (w->leaves != leaves)) {
            w = w->next;
        }
        if (w == NULL) {
            w = tb_new(1U, sizeof *w);
            w->leaves = leaves;
            w->next = c->all_ways;
            c->all_ways = w;
        }
        w->most = (d->most[level] > w->most) ? d->most[level] : w->most;
        c->ways[level] = w;
    }
    for (ways_t *w = c->all_ways; w != NULL; w = w->next) {
        if (w->leaves > 1U) {
            tabulate(w, c->words);
        }
    }
}

static void forget_ways(counting_t *c)
{
    while (c->all_ways != NULL) {
        ways_t *w = c->all_ways;
        c->all_ways = w->next;
        tb_free(w->table, (w->leaves > 1U) ? (((size_t)w->most + 1U) * c->words) : 0U, sizeof *w->table);
        tb_free(w, 1U, sizeof *w);
    }
    tb_free(c->ways, (size_t)c->d->levels + 1U, sizeof(ways_t *));
}

/* sum += number * factor */
static void plus_times(uint64_t *sum, const uint64_t *number, uint32_t factor, uint32_t words)
{
    uint64_t carry = 0U;
    for (uint32_t i = 0U; i < words; i++) {
        __extension__ const unsigned __int128 p = ((unsigned __int128)number[i] * factor) + sum[i] + carry;
        sum[i] = (uint64_t)p;
        carry = (uint64_t)(p >> (uint32_t)WORD_BITS);
    }
}

/* sum += number * ways to divide tokens at a level; 0 tokens: where they are is known */
static void plus_ways(const counting_t *c, uint64_t *sum, const uint64_t *number, uint32_t level, tb_count_t tokens)
{
    const ways_t *w = c->ways[level];
    const uint32_t *exact = sy_exact(c->d, level);
    if ((exact != NULL) && (tokens > 0U)) {
        plus_times(sum, number, exact[tokens], c->words);
    } else if ((w->leaves == 1U) || (tokens == 0U)) {
        plus(sum, number, c->words);
    } else {
        plus_product(sum, &w->table[(size_t)tokens * c->words], number, c->words);
    }
}

static uint64_t *of_node(const counting_t *c, uint64_t *numbers, uint32_t node)
{
    return &numbers[(uint64_t)node * c->words];
}

static void count_below(counting_t *c)
{
    const sy_frozen_t *f = c->f;
    c->below[0] = 1U;
    for (uint32_t i = 1U; i < f->nodes; i++) {
        for (uint64_t e = f->first[i]; e < f->first[i + 1U]; e++) {
            plus_ways(c, of_node(c, c->below, i), of_node(c, c->below, f->child[e]), f->level[i], f->tokens[e]);
        }
    }
}

static void count_above(counting_t *c)
{
    const sy_frozen_t *f = c->f;
    c->above[(uint64_t)(f->nodes - 1U) * c->words] = 1U;
    for (uint32_t i = f->nodes - 1U; i > 0U; i--) {
        for (uint64_t e = f->first[i]; e < f->first[i + 1U]; e++) {
            plus_ways(c, of_node(c, c->above, f->child[e]), of_node(c, c->above, i), f->level[i], f->tokens[e]);
        }
    }
}

/* The markings from a node downwards in which the places of a path hold the tokens that it needs. */
static const uint64_t *count_enabled(counting_t *c, uint32_t node, sy_path_t path, uint32_t transition)
{
    const sy_frozen_t *f = c->f;
    if (path == (sy_path_t)SY_END) {
        return of_node(c, c->below, node);
    }
    const sy_step_t *s = &c->d->step[path];
    if (f->level[node] < s->level) {
        return c->zero;
    }
    uint64_t *sum = of_node(c, c->enabled, node);
    if (c->of[node] == (transition + 1U)) {
        return sum;
    }
    c->of[node] = transition + 1U;
    (void)memset(sum, 0, c->words * sizeof *sum);
    const bool is_here = f->level[node] == s->level;
    for (uint64_t e = f->first[node]; e < f->first[node + 1U]; e++) {
        if (!is_here || sy_permits(s, f->tokens[e])) {
            const uint64_t *child = count_enabled(c, f->child[e], is_here ? s->rest : path, transition);
            plus_ways(c, sum, child, f->level[node], f->tokens[e] - (is_here ? s->take : 0U));
        }
    }
    if (tb_is_over()) {
        tb_fail(TB_EXIT_TIME, "time is over");
    }
    return sum;
}

static void count_arcs(counting_t *c, uint64_t *arcs)
{
    const sy_frozen_t *f = c->f;
    for (uint32_t t = 0U; t < c->d->net->transitions; t++) {
        const sy_path_t path = c->d->test[t];
        if (path == (sy_path_t)SY_END) {
            plus(arcs, of_node(c, c->below, f->nodes - 1U), c->words);
            continue;
        }
        const uint32_t level = c->d->step[path].level;
        for (uint32_t i = f->levels[level]; i < f->levels[level + 1U]; i++) {
            const uint64_t *here = count_enabled(c, f->at[i], path, t);
            plus_product(arcs, of_node(c, c->above, f->at[i]), here, c->words);
        }
    }
}

static void print_tokens(const sy_diagrams_t *d, const sy_frozen_t *f, const tb_job_t *job)
{
    int64_t *factor = tb_new((size_t)d->levels + 1U, sizeof *factor);
    int64_t in_marking = 0;
    int64_t in_place = 0;
    for (uint32_t l = 1U; l <= d->levels; l++) {
        factor[l] = 1;
        const bool is_value = (sy_exact(d, l) != NULL) && (d->most[l] > 0U);
        const int64_t most = is_value ? 1 : (int64_t)d->most[l];
        in_place = (most > in_place) ? most : in_place;
    }
    bool is_small = sy_largest(f, factor, &in_marking); /* at most 2^32 places with 2^30 tokens */
    for (uint32_t i = 0U; is_small && (i < job->questions); i++) {
        const tb_formula_t *sum = job->question[i].formula;
        int64_t most = 0;
        is_small = sy_largest_of(d, f, sum, &most) && !__builtin_sub_overflow(most, sum->limit, &most);
        in_marking = (i == 0U) ? most : in_marking;
        in_place = ((i > 0U) && (most > in_place)) ? most : in_place;
    }
    if (!is_small) {
        tb_fail(TB_EXIT_MEMORY, "a sum is too large");
    }
    (void)printf(" %" PRId64 " %" PRId64 "\n", in_place, in_marking);
    (void)fflush(stdout);
    tb_free(factor, (size_t)d->levels + 1U, sizeof *factor);
}

void sy_say_sizes(sy_diagrams_t *d, const sy_frozen_t *f, const tb_job_t *job)
{
    const double all = bits(d, f, job) + log2((double)d->net->transitions + 1.0) + 2.0;
    counting_t c = { .d = d, .f = f, .words = 1U + (uint32_t)(all / (double)WORD_BITS) };
    const uint64_t numbers = (uint64_t)f->nodes * c.words;
    c.below = tb_new(numbers, sizeof(uint64_t));
    c.above = tb_new(numbers, sizeof(uint64_t));
    c.enabled = tb_new(numbers, sizeof(uint64_t));
    c.of = tb_new(f->nodes, sizeof *c.of);
    c.zero = tb_new(c.words, sizeof(uint64_t));
    find_ways(&c, job);
    uint64_t *arcs = tb_new(c.words, sizeof *arcs);
    count_below(&c);
    count_above(&c);
    count_arcs(&c, arcs);
    (void)printf("sizes");
    print(of_node(&c, c.below, f->nodes - 1U), c.words);
    print(arcs, c.words);
    print_tokens(d, f, job);
    forget_ways(&c);
    tb_free(c.below, numbers, sizeof(uint64_t));
    tb_free(c.above, numbers, sizeof(uint64_t));
    tb_free(c.enabled, numbers, sizeof(uint64_t));
    tb_free(c.of, f->nodes, sizeof *c.of);
    tb_free(c.zero, c.words, sizeof(uint64_t));
    tb_free(arcs, c.words, sizeof *arcs);
}
