/*
 * voice_plan.c - items of a voice to phonemes in time (voice_parts.h).
 *
 * The plan makes one segment after the other, when the stream needs it, and notes up to where it has looked at items:
 * items behind that change nothing that it made. It begins at any time, with a few items before it.
 */
#include "voice_parts.h"

/* Between phonemes, milliseconds that come from rounding. */
#define PHONEME_ROUNDING 1u

/* What the last viseme lasts, milliseconds. */
#define LAST_VISEME 100u

/* Phonemes of labial/words.h. */
enum { V_SIL, V_AA, V_AE, V_AH, V_AO, V_AW, V_AY, V_B, V_EH = 11, V_ER, V_EY, V_F, V_HH = 16, V_IH, V_IY };
enum { V_K = 20, V_L, V_N = 23, V_OW = 25, V_OY, V_P, V_R, V_S, V_SH, V_UH = 33, V_UW, V_W = 36, V_Y };
enum { V_CH = 8, V_DH = 10 };

/* Each viseme stands for the phoneme that is most frequent in English among those that it covers or, if two are equally
 * frequent, for the one that it is named after: Azure's ids (Microsoft's table of phonemes for en-US); Polly's symbols
 * (Amazon's tables of en-US and en-GB; B, J and x are of its other languages). */
static const uint8_t azure_phonemes[] = { V_SIL, V_AH, V_AA, V_AO, V_EH, V_ER, V_IH, V_UW, V_OW, V_AW, V_OY,
                                          V_AY,  V_HH, V_R,  V_L,  V_S,  V_SH, V_DH, V_F,  V_N,  V_K,  V_P };
static const char polly_names[] = "ptSTfkirslu@aeEoOBJx"; /* the first one is "sil" */
static const uint8_t polly_phonemes[] = { V_SIL, V_P,  V_N,  V_SH, V_DH, V_F,  V_K,  V_IH, V_R, V_S, V_L,
                                          V_UW,  V_AH, V_AE, V_EY, V_EH, V_OW, V_AO, V_B,  V_Y, V_K };

/* Phonemes that Azure reports in two events: "8 4", "4 6" and "19 16". */
static const uint8_t azure_pairs[][3] = { { 8, 4, V_OW }, { 4, 6, V_EY }, { 19, 16, V_CH } };

/* A bit for each vowel. */
#define VISEME_BIT(phoneme) (UINT64_C(1) << (phoneme))
#define VISEME_VOWELS                                                                                                  \
    (VISEME_BIT(V_AA) | VISEME_BIT(V_AE) | VISEME_BIT(V_AH) | VISEME_BIT(V_AO) | VISEME_BIT(V_AW) | VISEME_BIT(V_AY) | \
     VISEME_BIT(V_EH) | VISEME_BIT(V_ER) | VISEME_BIT(V_EY) | VISEME_BIT(V_IH) | VISEME_BIT(V_IY) | VISEME_BIT(V_OW) | \
     VISEME_BIT(V_OY) | VISEME_BIT(V_UH) | VISEME_BIT(V_UW))

/* ---- Visemes ----------------------------------------------------------------------------------------------------- */

int labial_voice_viseme(unsigned kind, const char *text, size_t size)
{
    int number = 0;
    if (kind == LABIAL_VOICE_AZURE) {
        if (size == 0u || size > 2u || (size == 2u && text[0] == '0'))
            return -1;
        for (; size > 0u; size--, text++) {
            if (*text < '0' || *text > '9')
                return -1;
            number = number * 10 + (*text - '0');
        }
        return number < (int)sizeof azure_phonemes ? number : -1;
    }
    if (size == 3u && text[0] == 's' && text[1] == 'i' && text[2] == 'l')
        return 0;
    while (size == 1u && polly_names[number])
        if (polly_names[number++] == *text)
            return number;
    return -1;
}

/* The phoneme that a viseme and the one at `after` are together, or 0. */
static unsigned viseme_pair(const labial_voice_t *voice, const labial_voice_utterance_t *utterance, uint32_t at,
                            uint32_t after)
{
    unsigned i;
    if (utterance->kind == LABIAL_VOICE_AZURE && after < labial_voice_limit(utterance))
        for (i = 0; i < sizeof azure_pairs / sizeof *azure_pairs; i++)
            if (azure_pairs[i][0] == voice->items[at].text[0] && azure_pairs[i][1] == voice->items[after].text[0])
                return azure_pairs[i][2];
    return 0;
}

/* The phoneme of the viseme at `at`, or of the pair that it begins; moves `at` behind it. */
static unsigned viseme_phoneme(const labial_voice_t *voice, const labial_voice_utterance_t *utterance, uint32_t *at)
{
    const uint32_t first = *at, after = labial_voice_after(voice, first);
    const unsigned number = voice->items[first].text[0], pair = viseme_pair(voice, utterance, first, after);
    *at = pair ? labial_voice_after(voice, after) : after;
    return pair ? pair : utterance->kind == LABIAL_VOICE_AZURE ? azure_phonemes[number] : polly_phonemes[number];
}

static int next_viseme(labial_voice_t *voice, const labial_voice_utterance_t *utterance)
{
    labial_voice_plan_t *const plan = &voice->plan;
    const uint32_t limit = labial_voice_limit(utterance);
    uint32_t follows;
    unsigned phoneme;
    labial_voice_look(plan, plan->at);
    if (plan->at >= limit)
        return 0;
    plan->start = voice->items[plan->at].start;
    labial_voice_look(plan, labial_voice_after(voice, plan->at));
    phoneme = viseme_phoneme(voice, utterance, &plan->at);
    labial_voice_look(plan, plan->at);
    follows = plan->at;
    plan->end = voice->items[limit - utterance->tail].start + LAST_VISEME;
    if (follows < limit) {
        unsigned next;
        plan->end = voice->items[follows].start;
        labial_voice_look(plan, labial_voice_after(voice, follows));
        next = viseme_phoneme(voice, utterance, &follows);
        if (phoneme == V_UW && next != V_UW && (VISEME_VOWELS & VISEME_BIT(next))) /* rounded lips before a vowel */
            phoneme = V_W;
    }
    plan->phoneme = labial_voice_number(voice, phoneme);
    return 1;
}

/* ---- Phonemes ---------------------------------------------------------------------------------------------------- */

/* Each phoneme lasts until the next one if the gap between them is short, and no longer. */
static int next_phoneme(labial_voice_t *voice, const labial_voice_utterance_t *utterance)
{
    labial_voice_plan_t *const plan = &voice->plan;
    const labial_voice_place_t *const item = voice->items + plan->at;
    uint32_t after;
    labial_voice_look(plan, plan->at);
    if (plan->at >= labial_voice_limit(utterance))
        return 0;
    after = labial_voice_after(voice, plan->at);
    labial_voice_look(plan, after);
    plan->start = item->start;
    plan->end = item->end == LABIAL_VOICE_OPEN ? item->start : item->end;
    if (plan->joins && plan->start <= plan->previous + PHONEME_ROUNDING) /* and not much before it, as it ended here */
        plan->start = plan->previous;
    if (after < labial_voice_limit(utterance)) {
        const uint32_t gap = item->text[2] | (uint32_t)item->text[3] << 8, next = voice->items[after].start;
        if (plan->end < next ? next - plan->end <= gap : plan->end > next + PHONEME_ROUNDING)
            plan->end = next;
    }
    if (plan->end < plan->start)
        plan->end = plan->start;
    plan->phoneme = item->text[0];
    plan->previous = plan->end;
    plan->joins = 1;
    plan->at = after;
    return 1;
}

/* ---- The plan ---------------------------------------------------------------------------------------------------- */

/* Goes to the items of the current utterance that matter from `plan->moment` on. */
static void enter_utterance(labial_voice_t *voice)
{
    labial_voice_plan_t *const plan = &voice->plan;
    const labial_voice_utterance_t *const utterance = voice->utterances + plan->utterance;
    const uint32_t limit = labial_voice_limit(utterance);
    const int64_t moment = plan->moment - utterance->origin - voice->offset;
    unsigned back = utterance->kind == LABIAL_VOICE_CHARACTERS ? LABIAL_VOICE_BACK : LABIAL_VOICE_BACK_FEW;
    uint32_t at = utterance->first, after = at;
    while (after < limit && voice->items[after].start <= moment) {
        at = after;
        after = labial_voice_after(voice, at);
    }
    while (at > utterance->first) {
        const uint32_t before = labial_voice_before(voice, utterance, at);
        if (back > 0u)
            back--;
        else if (utterance->kind == LABIAL_VOICE_CHARACTERS ? labial_voice_is_blank_item(voice, before)
                                                            : !viseme_pair(voice, utterance, before, at))
            break;
        at = before;
    }
    plan->at = at;
    plan->joins = plan->byte = plan->point = plan->closing = plan->ended = plan->characters = plan->size = 0;
    plan->time = 0;
    if (utterance->kind >= LABIAL_VOICE_WORDS && utterance->places > 0u)
        (void)labial_words_init(&plan->words, voice->words, voice->own, 0); /* both are known, or nothing was told */
}

void labial_voice_plan_start(labial_voice_t *voice, int64_t moment)
{
    voice->plan.moment = moment;
    voice->plan.seen = 0;
    voice->plan.has = 0;
    voice->plan.utterance = 0;
    voice->stale = 0;
    if (voice->utterance_count > 0u)
        enter_utterance(voice);
}

/* Whether a phoneme comes next; makes it. */
static int has_phoneme(labial_voice_t *voice)
{
    labial_voice_plan_t *const plan = &voice->plan;
    while (!plan->has && plan->utterance < voice->utterance_count) {
        const labial_voice_utterance_t *const utterance = voice->utterances + plan->utterance;
        if (utterance->places == 0u)
            plan->has = 0;
        else if (utterance->kind == LABIAL_VOICE_PHONEMES)
            plan->has = (uint8_t)next_phoneme(voice, utterance);
        else if (utterance->kind < LABIAL_VOICE_WORDS)
            plan->has = (uint8_t)next_viseme(voice, utterance);
        else
            plan->has = (uint8_t)voice->speak(voice);
        if (!plan->has) {
            labial_voice_look(plan, labial_voice_limit(utterance));
            plan->utterance++;
            if (plan->utterance < voice->utterance_count)
                enter_utterance(voice);
        }
    }
    return plan->has;
}

void labial_voice_plan_next(labial_voice_t *voice, labial_voice_segment_t *segment)
{
    labial_voice_plan_t *const plan = &voice->plan;
    int64_t silent = plan->moment; /* up to which there is silence */
    segment->start = plan->moment;
    segment->phoneme = voice->model->silence;
    while (has_phoneme(voice)) {
        const labial_voice_utterance_t *const utterance = voice->utterances + plan->utterance;
        const int64_t shift = utterance->origin + voice->offset;
        const int64_t start = plan->start + shift > silent ? plan->start + shift : silent;
        const int64_t told = plan->end + utterance->origin;
        const int64_t end = (told < utterance->limit ? told : utterance->limit) + voice->offset;
        if (end > start && plan->phoneme != voice->model->silence) {
            if (start == plan->moment) {
                segment->phoneme = plan->phoneme;
                plan->has = 0;
                silent = end;
            } else {
                silent = start;
            }
            segment->end = plan->moment = silent;
            return;
        }
        if (end > start)
            silent = end;
        plan->has = 0;
    }
    segment->end = INT64_MAX;
    plan->seen = UINT32_MAX;
}

int labial_voice_plan_sounds(labial_voice_t *voice)
{
    labial_voice_plan_start(voice, INT32_MIN);
    while (has_phoneme(voice)) {
        if (voice->plan.phoneme != voice->model->silence)
            return 1;
        voice->plan.has = 0;
    }
    return 0;
}

int64_t labial_voice_end(labial_voice_t *voice, unsigned position)
{
    const labial_voice_utterance_t *const utterance = voice->utterances + position;
    uint32_t end = utterance->end;
    if (utterance->places > 0u) {
        const labial_voice_place_t *const last = voice->items + (labial_voice_limit(utterance) - utterance->tail);
        uint32_t until = 0;
        if (utterance->kind == LABIAL_VOICE_AZURE || utterance->kind == LABIAL_VOICE_POLLY)
            until = last->start + LAST_VISEME;
        else if (utterance->kind == LABIAL_VOICE_WORDS && (last->end == LABIAL_VOICE_OPEN || last->end == last->start))
            until = last->start + voice->lasts(voice, utterance);
        if (until > end)
            end = until;
    }
    return utterance->origin + end;
}
