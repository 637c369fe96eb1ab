/* What unity.h declares: counts, and lines in the form of Unity's, `file:line:test:verdict: message`. */
#include "unity.h"

static struct {
    const char *file, *test;
    unsigned tests, failures, ignored;
    int failed, passed_over; /* the present test */
} run;

static void report(unsigned line, const char *test, const char *verdict)
{
    board_print(run.file ? run.file : "?");
    board_put(':');
    board_print_unsigned(line);
    board_put(':');
    board_print(test);
    board_put(':');
    board_print(verdict);
}

static void say(const char *text)
{
    if (text && text[0]) {
        board_print(": ");
        board_print(text);
    }
}

static void print(uint32_t value, int is_signed)
{
    if (is_signed)
        board_print_signed((int32_t)value);
    else
        board_print_unsigned(value);
}

void stand_in_begin(void)
{
    run.tests = run.failures = run.ignored = 0;
}

void stand_in_set_file(const char *file)
{
    run.file = file;
}

void stand_in_run(void (*test)(void), const char *name, unsigned line)
{
    run.test = name;
    run.failed = run.passed_over = 0;
    run.tests++;
    setUp();
    test();
    tearDown();
    if (run.failed) {
        run.failures++;
    } else if (run.passed_over) {
        run.ignored++;
    } else {
        report(line, name, "PASS");
        board_put('\n');
    }
}

void stand_in_fail(unsigned line, const char *what, const char *message)
{
    run.failed = 1;
    report(line, run.test, "FAIL");
    say(what);
    say(message);
    board_put('\n');
}

void stand_in_ignore(unsigned line, const char *message)
{
    run.passed_over = 1;
    report(line, run.test, "IGNORE");
    say(message);
    board_put('\n');
}

void stand_in_compare(uint32_t wanted, uint32_t actual, char relation, int is_signed, unsigned line,
                      const char *message)
{
    const int holds = relation == '='   ? actual == wanted
                      : relation == '<' ? actual < wanted
                      : relation == '>' ? actual > wanted
                                        : actual <= wanted;
    if (holds)
        return;
    run.failed = 1;
    report(line, run.test, "FAIL: expected ");
    if (relation != '=')
        board_print(relation == '<' ? "less than " : relation == '>' ? "more than " : "at most ");
    print(wanted, is_signed);
    board_print(" was ");
    print(actual, is_signed);
    say(message);
    board_put('\n');
}

int stand_in_end(void)
{
    board_print("-----------------------\n");
    board_print_unsigned(run.tests);
    board_print(" Tests ");
    board_print_unsigned(run.failures);
    board_print(" Failures ");
    board_print_unsigned(run.ignored);
    board_print(" Ignored\n");
    board_print(run.failures ? "FAIL\n" : "OK\n");
    return (int)run.failures;
}
