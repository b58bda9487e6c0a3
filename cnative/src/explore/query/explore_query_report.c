/* SPDX-License-Identifier: MIT
 * explore_query_report.c - the answers as a member of the report.
 */
#include "explore_query.h"

#include <inttypes.h>

#include "pn/pn_text.h"

static void print_string(const char *string, FILE *out)
{
    char quoted[2U * EX_PATH_SIZE];
    pn_text_t text;
    pn_text_init(&text, quoted, sizeof quoted);
    pn_text_json_str(&text, string);
    (void)fputs(quoted, out);
}

static void print_value(const ex_question_t *question, FILE *out)
{
    char buffer[64];
    pn_text_t text;
    pn_text_init(&text, buffer, sizeof buffer);
    if (question->value_kind == EX_REAL) {
        pn_text_json_real(&text, question->value);
    } else if (question->value_kind == EX_INTEGER) {
        pn_text_int(&text, (int64_t)question->value);
    } else {
        pn_text_str(&text, "null");
    }
    (void)fputs(buffer, out);
}

static void print_answer(const ex_run_t *run, const ex_question_t *question, uint32_t number, FILE *out)
{
    static const char *const s_answers[] = { "unknown", "yes", "no" };
    char path[EX_PATH_SIZE];
    (void)fprintf(out, "{\"answer\": \"%s\", \"why\": ", s_answers[question->answer]);
    if (question->why != NULL) {
        print_string(question->why, out);
    } else {
        (void)fprintf(out, "null");
    }
    if (question->node != EX_NO_NODE) {
        (void)fprintf(out, ", \"node\": %" PRIu64, (uint64_t)question->node + 1U);
    } else {
        (void)fprintf(out, ", \"node\": null");
    }
    (void)fprintf(out, ", \"trace\": ");
    if (question->steps >= 0) {
        (void)snprintf(path, sizeof path, "%s%" PRIu32 ".trace.jsonl", run->options.query_trace_to, number);
        print_string(path, out);
        (void)fprintf(out, ", \"steps\": %" PRId64, question->steps);
    } else {
        (void)fprintf(out, "null, \"steps\": null");
    }
    if ((question->path.node != NULL) && !question->path.is_failed && (question->path.loop >= 0)) {
        (void)fprintf(out, ", \"loop\": %" PRId64, question->path.loop);
    } else {
        (void)fprintf(out, ", \"loop\": null");
    }
    (void)fprintf(out, ", \"value\": ");
    print_value(question, out);
    (void)fprintf(out, "}");
}

void ex_queries_json(const ex_run_t *run, bool is_early, FILE *out)
{
    if (run->queries == NULL) {
        return;
    }
    (void)fprintf(out, ",\n \"queries\": [");
    for (uint32_t i = 0U; i < run->queries->questions; i++) {
        (void)fprintf(out, "%s", (i > 0U) ? ",\n  " : "");
        ex_question_t said = run->queries->question[i];
        if (is_early) {
            ex_early_expect(run, &said);
        }
        print_answer(run, &said, i, out);
    }
    (void)fprintf(out, "]");
}
