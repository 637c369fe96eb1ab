/*
 * oracle_units.c - phonemes to frames, from the whole of the input.
 */
#include "oracle.h"

#include <stdlib.h>

typedef struct {
    size_t input; /* the phoneme's number */
    uint64_t begin, end;
} span_t;

static unsigned ahead_of(const labial_model_t *model)
{
    const unsigned kernels =
        model->kernel_taps ? (unsigned)(model->kernel_taps - 1 - model->kernel_behind) * model->kernel_stride : 0;
    const unsigned stops = model->floor_count ? 3 : 0; /* to see whether a phoneme is shorter than that */
    return kernels > stops ? kernels : stops;
}

/* Where every phoneme lies that has a frame: frames are those of the rounded sum of all durations up to it. */
static size_t lay(const labial_model_t *const *models, const fixture_phoneme_t *input, size_t count, span_t *spans)
{
    const uint64_t rate = models[0]->frames_per_second;
    uint64_t ms = 0, end = 0;
    size_t n = 0;
    for (size_t i = 0; i < count; i++) {
        const uint64_t begin = end;
        ms += input[i].ms;
        end = (ms * rate * 2 + 1000) / 2000;
        if (end > begin) {
            spans[n].input = i;
            spans[n].begin = begin;
            spans[n++].end = end;
        }
    }
    return n;
}

/* The phonemes that must be pushed before a frame of span `s` can be taken that needs to see frame `last`. */
static size_t needs(const span_t *spans, size_t n, size_t s, uint64_t last)
{
    size_t i = s + 1;
    while (i < n && spans[i].end <= last)
        i++;
    return i < n ? spans[i].input + 1 : SIZE_MAX;
}

size_t oracle_units(const labial_model_t *const *models, const fixture_phoneme_t *input, size_t count,
                    oracle_frame_t *frames, size_t room)
{
    span_t *spans = (span_t *)malloc((count + 1) * sizeof *spans);
    size_t total = 0;
    if (!spans)
        abort();
    const size_t n = lay(models, input, count, spans);
    for (size_t s = 0; s < n; s++) {
        const fixture_phoneme_t *own = &input[spans[s].input];
        const fixture_phoneme_t *before = s > 0 ? &input[spans[s - 1].input] : NULL;
        const fixture_phoneme_t *behind = s + 1 < n ? &input[spans[s + 1].input] : NULL;
        const labial_model_t *model = models[own->model];
        const unsigned ahead = ahead_of(model), all_ms = own->ms < 65535 ? own->ms : 65535;
        const uint64_t length = spans[s].end - spans[s].begin;
        const uint64_t cut = own->phoneme == model->silence && ahead > 0 && length > ahead ? length - ahead : 0;
        const int begins = !before || before->model != own->model, ends = !behind || behind->model != own->model;
        for (uint64_t i = 0; i < length; i++) {
            oracle_frame_t *frame = &frames[total];
            if (total++ == room)
                abort();
            frame->phoneme = own->phoneme;
            frame->model = own->model;
            frame->previous = begins ? model->silence : before->phoneme;
            frame->next = ends ? model->silence : behind->phoneme;
            frame->ms = all_ms;
            frame->needs = needs(spans, n, s, spans[s].begin + i + ahead);
            if (i < cut) {
                frame->ms = all_ms - ahead * 1000 / model->frames_per_second;
                frame->next = model->silence;
                frame->needs = spans[s].input + 1;
            } else if (cut > 0) {
                frame->ms = ahead * 1000 / model->frames_per_second;
                frame->previous = model->silence;
            }
            frame->is_first = i == 0 || i == cut;
            frame->rest = cut == 0 || (i >= cut && !ends) ? 0 : i < 15 && !begins ? (unsigned)i + 1 : 16;
            frame->number = i < cut ? i : i - cut;
            frame->whole = i < cut ? cut : length - cut;
            frame->begins = begins && i == 0;
            frame->ends = ends && i + 1 == length;
            frame->unit_ends = i + 1 == length && (ends || model->phonemes[own->phoneme].boundary);
        }
    }
    free(spans);
    return total;
}

unsigned oracle_label(const labial_model_t *const *models, const oracle_frame_t *frames, size_t count, size_t at,
                      int offset)
{
    const labial_model_t *model = models[frames[at].model];
    for (; offset > 0; offset--, at++)
        if (frames[at].ends || at + 1 == count)
            return model->silence;
    for (; offset < 0; offset++, at--)
        if (frames[at].begins)
            return model->silence;
    return frames[at].phoneme;
}
