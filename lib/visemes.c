/*
 * visemes.c - the sounds that a frame shows, and the tongue (labial/visemes.h). It reads what the steps of a stream
 * hold and changes nothing.
 */
#include "labial/visemes.h"

#include "fade.h"
#include "fixed.h"
#include "locks.h"

/* How far around the delivered frame a sound can count: no onset or release below lasts longer. */
#define AROUND_MS 120u

/* Strength, and how fast it falls off: per millisecond before the sound begins and after it has ended. */
typedef struct {
    uint16_t strength;
    uint8_t onset, release;
} dominance_t;

/* Lips round early (onsets of 112 ms and less), and closed lips and teeth on the lip part fast (40 ms). The reference
 * is export/labial/reference/visemes.py. */
static const dominance_t dominances[LABIAL_VISEMES] = {
    { 384, 6, 6 },   { 2048, 51, 51 }, { 2048, 51, 51 }, { 1536, 34, 51 }, { 512, 10, 12 },
    { 512, 10, 12 }, { 1280, 16, 21 }, { 1024, 20, 25 }, { 512, 10, 12 },  { 768, 12, 12 },
    { 640, 10, 10 }, { 640, 10, 10 },  { 640, 10, 10 },  { 896, 9, 11 },   { 896, 8, 11 },
};

#define V(name) LABIAL_VISEME_##name
const uint8_t labial_arpabet_visemes[LABIAL_ARPABET_PHONEMES] = {
    V(SIL), V(AA), V(AA), V(AA), V(OH), V(AA), V(AA),   V(PP), V(CH), V(DD), /* SIL AA AE AH AO AW AY B CH D */
    V(TH),  V(E),  V(RR), V(E),  V(FF), V(KK), V(NONE), V(IH), V(IH), V(CH), /* DH EH ER EY F G HH IH IY JH */
    V(KK),  V(NN), V(PP), V(NN), V(KK), V(OH), V(OH),   V(PP), V(RR), V(SS), /* K L M N NG OW OY P R S */
    V(CH),  V(DD), V(TH), V(OU), V(OU), V(FF), V(OU),   V(IH), V(SS), V(CH), /* SH T TH UH UW V W Y Z ZH */
};

const uint8_t labial_heard_visemes[LABIAL_HEARD_CLASSES] = {
    V(SIL),  V(PP), V(FF), V(TH), V(DD), V(NN), V(SS), V(CH), V(KK), /* SIL M F TH T L S SH K */
    V(NONE), V(RR), V(RR), V(OU), V(IH), V(IH), V(E),  V(AA), V(AA), /* HH R ER W IY IH EH AE AH */
    V(AA),   V(OH), V(OH), V(OU), V(OU), V(AA), V(AA), V(E),         /* AA AO OW UW UH AY AW EY */
};
#undef V

/* Raises each sound's dominance to that of a phoneme `ms` milliseconds away, `later` if it is still to come. */
static void dominate(uint16_t dominance[LABIAL_VISEMES], unsigned viseme, uint32_t ms, int later)
{
    const dominance_t *row;
    uint32_t lost;
    if (viseme == LABIAL_VISEME_NONE)
        return;
    if (viseme >= LABIAL_VISEMES)
        viseme = LABIAL_VISEME_SIL;
    row = &dominances[viseme];
    lost = ms * (later ? row->onset : row->release);
    if (lost < row->strength && row->strength - lost > dominance[viseme])
        dominance[viseme] = (uint16_t)(row->strength - lost);
}

/* The dominances as shares of `whole`; what they leave is silence's. */
static void share_out(const uint16_t dominance[LABIAL_VISEMES], uint32_t whole, uint8_t shares[LABIAL_VISEMES])
{
    uint32_t sum = 0, reciprocal;
    unsigned i;
    for (i = 0; i < LABIAL_VISEMES; i++)
        sum += dominance[i];
    reciprocal = sum > 0 ? labial_quotient(whole << 16, sum) : 0u; /* at most 2^23 */
    for (i = 0; i < LABIAL_VISEMES; i++)
        shares[i] = (uint8_t)((dominance[i] * reciprocal + 32768u) >> 16); /* no dominance exceeds the sum */
    if (sum == 0)
        whole = 0;
    shares[LABIAL_VISEME_SIL] = (uint8_t)(shares[LABIAL_VISEME_SIL] + LABIAL_VISEME_ONE - whole);
}

/* The part of the frame's sound that the face still shows: all of it in motion, less on the way to rest. */
static uint32_t shown(const labial_t *stream)
{
    if (!stream->resting)
        return stream->begun ? LABIAL_VISEME_ONE : 0u;
    return labial_fade_left(&stream->fade, LABIAL_VISEME_ONE);
}

/* What the sounds of a frame and of up to `count` frames after it, or before it, are in it. `label` is the frame's
 * phoneme among those around it. */
static void gather(const labial_model_t *model, const uint8_t *visemes, const uint8_t *label, uint32_t count,
                   uint32_t period, int later, uint16_t dominance[LABIAL_VISEMES])
{
    uint32_t k, ms;
    for (k = 0, ms = 0; ms < AROUND_MS && k <= count; k++, ms += period) {
        const unsigned phoneme = *(later ? label + k : label - k);
        if (phoneme < model->phoneme_count)
            dominate(dominance, visemes[phoneme], ms, later);
    }
}

/* Gathers the sounds of the frame that was delivered last; returns how much of them the face shows. */
static uint32_t sounds_of(const labial_t *stream, const labial_model_t *model, const uint8_t *visemes,
                          uint16_t dominance[LABIAL_VISEMES])
{
    const labial_units_t *const units = &stream->units;
    const uint32_t place = stream->pending - units->frames; /* frames that were accepted and are not delivered */
    const uint32_t whole = shown(stream);
    const uint8_t *label;
    uint32_t period;
    /* At a change of model the labels of the frames before it are gone, and they show what follows. */
    if (LABIAL_PAPER || place > LABIAL_REACH || whole == 0 || stream->models[stream->channels.slots[0]] != model)
        return 0;
    label = &units->labels[LABIAL_REACH - place];
    period = labial_quotient(1000u, (uint32_t)model->frames_per_second);
    gather(model, visemes, label, LABIAL_REACH - place, period, 0, dominance);
    gather(model, visemes, label, LABIAL_REACH + place, period, 1, dominance);
    return whole;
}

int labial_visemes(const labial_t *stream, const labial_model_t *model, const uint8_t *visemes,
                   uint8_t shares[LABIAL_VISEMES])
{
    uint16_t dominance[LABIAL_VISEMES] = { 0 };
    uint32_t whole = 0;
    int result = LABIAL_ERROR_STATE;
    if (!stream || !model || !visemes || !shares)
        return LABIAL_ERROR_NULL;
    LABIAL_LOCK(stream);
    if (stream->magic == LABIAL_MAGIC_) {
        whole = sounds_of(stream, model, visemes, dominance);
        result = LABIAL_OK;
    }
    LABIAL_UNLOCK(stream);
    if (result == LABIAL_OK)
        share_out(dominance, whole, shares);
    return result;
}

/* FAP 44, 45 and 46 of each viseme; the others stay 0, since English moves the tongue neither sideways nor rolls it. */
static const int16_t tongues[LABIAL_VISEMES][3] = {
    { 0, 0, 0 },         { 0, 0, 0 },     { 0, 0, 0 },      { 160, 240, 40 },   { 400, 60, 80 },
    { -120, -100, 420 }, { 300, 0, 260 }, { 260, 40, 160 }, { 400, 60, 60 },    { 300, -120, 200 },
    { -80, -40, -80 },   { 40, 20, 160 }, { 60, 40, 320 },  { -60, -120, 120 }, { -40, -120, 280 },
};

void labial_tongue(const uint8_t shares[LABIAL_VISEMES], int16_t tongue[LABIAL_TONGUE_FAPS])
{
    unsigned i, k;
    if (!shares || !tongue)
        return;
    tongue[0] = tongue[4] = 0;
    for (k = 0; k < 3; k++) {
        int32_t sum = LABIAL_VISEME_ONE / 2; /* 15 shares of 255 stay below 2^22 */
        for (i = 0; i < LABIAL_VISEMES; i++)
            sum += (int32_t)shares[i] * tongues[i][k];
        tongue[1 + k] = (int16_t)(sum >> 7);
    }
}
