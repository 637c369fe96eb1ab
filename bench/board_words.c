/*
 * board_words.c - what reading words costs on a board: prints names and numbers, one pair a line.
 *
 * BENCH_WORDS of bench_words.h are common words of English. What is counted, in instructions: every call of
 * labial_words_read(); and for every word, with its times, labial_words_push() and all labial_words_next() up to the next
 * word. The stack is that of all of these.
 */
#include "bench_words.h"
#include "board.h"
#include "labial/labial.h"
#include "words_en.h"

static const char *const words[] = { BENCH_WORDS };
static labial_words_t stream;
static labial_word_t word;
static uint32_t phonemes, checksum;

static void take(void)
{
    unsigned phoneme;
    uint32_t milliseconds;
    while (labial_words_next(&stream, &phoneme, &milliseconds) == LABIAL_OK) {
        phonemes++;
        checksum = checksum * 31u + phoneme + (milliseconds << 8);
    }
}

int main(void)
{
    uint32_t number, time = 0, reading = 0, reading_worst = 0, saying = 0, saying_worst = 0, deepest;
    board_stack_paint();
    if (labial_words_init(&stream, &words_en, NULL, 0) != LABIAL_OK)
        return 1;
    for (number = 0; number < sizeof words / sizeof words[0]; number++) {
        const char *const text = words[number];
        uint32_t taken, size = 0;
        while (text[size] != '\0')
            size++;
        board_count_start();
        labial_words_read(&words_en, NULL, text, size, &word);
        taken = board_count();
        if (taken == BOARD_COUNT_OVERFLOW)
            return 2;
        reading += taken;
        reading_worst = taken > reading_worst ? taken : reading_worst;
        board_count_start();
        labial_words_push(&stream, text, size, time, time + 40u * size);
        take();
        taken = board_count();
        if (taken == BOARD_COUNT_OVERFLOW)
            return 2;
        saying += taken;
        saying_worst = taken > saying_worst ? taken : saying_worst;
        time += 50u * size + (number % 10u < 9u ? 0u : 200u); /* a gap that is bridged, and a pause every ten words */
    }
    labial_words_end(&stream);
    take();
    deepest = board_stack_depth();

    board_print_within("words ", number, "\n");
    board_print_within("phonemes ", phonemes, "\n");
    board_print_within("read_instructions ", reading, "\n");
    board_print_within("read_worst ", reading_worst, "\n");
    board_print_within("say_instructions ", saying, "\n");
    board_print_within("say_worst ", saying_worst, "\n");
    board_print_within("stack ", deepest, "\n");
    board_print_within("checksum ", checksum, "\n");
    return 0;
}
