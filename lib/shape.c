/*
 * shape.c - phonemes to targets (shape.h): equation 2, pairs, kernels, floors and contact, rest.
 */
#include "shape.h"

#include <stddef.h>
#include <string.h>

#include "fixed.h"

#define ONE 4096u /* the whole of a mixture, Q12 */

/* Largest z of a duration: over a thousand standard deviations, so that the widest component takes an endless pause. */
#define DURATION_Z_MAX 65535u

/* Durations farther than three standard deviations from a component's mean change its shape no more: 3 / sqrt 2, Q6. */
#define SLOPE_Z_MAX 136

/* exp(-i / 2) and exp(-i / 32), Q15: a cost difference of 16 h + l has likelihood coarse[h] * fine[l]. */
static const uint16_t coarse[16] = { 32768, 19875, 12055, 7312, 4435, 2690, 1631, 990,
                                     600,   364,   221,   134,  81,   49,   30,   18 };
static const uint16_t fine[16] = { 32768, 31760, 30783, 29836, 28918, 28028, 27166, 26330,
                                   25520, 24735, 23974, 23236, 22521, 21828, 21157, 20506 };

/* By how much lips part between two contacts, FAP: half a standard deviation of the lips in speech, in FAPs 51, 52, 55
 * to 58; 0 in those that do not part. */
static const uint8_t parted[LABIAL_CHANNELS] = { 0, 0, 0, 28, 100, 0, 0, 25, 25, 86, 86, 0, 0 };

/* Q15 */
static uint32_t likelihood(uint32_t cost)
{
    if (cost > 255u)
        return 0;
    return ((uint32_t)coarse[cost >> 4] * fine[cost & 15u]) >> 15;
}

/* part / sum in Q12, rounded down; `inverse` is 2^31 / sum, rounded down, with which the product is short of the
 * quotient by less than 1 / 16. */
static uint32_t likelihood_share(uint32_t part, uint32_t sum, uint32_t inverse)
{
    const uint32_t share = (part * inverse) >> 19;
    return share + ((share + 1u) * sum <= part * ONE);
}

/* Costs and signed, limited z of a phoneme's components; returns the best one's index within the phoneme. */
static unsigned score(const labial_model_t *model, const labial_spoken_t *spoken, uint32_t *costs, int32_t *deviations)
{
    const labial_phoneme_t *phonemes = model->phonemes, *phoneme = &phonemes[spoken->phoneme];
    const unsigned previous_class = phonemes[spoken->previous].viseme_class;
    const unsigned next_class = phonemes[spoken->next].viseme_class;
    uint32_t least = UINT32_MAX;
    unsigned c, best = 0;
    for (c = 0; c < phoneme->component_count; c++) {
        const unsigned index = phoneme->first_component + c;
        const labial_component_t *component = &model->components[index];
        const int32_t distance = (int32_t)spoken->ms - component->duration_mean;
        const uint32_t z =
            labial_z((uint32_t)(distance < 0 ? -distance : distance), component->duration_gain, DURATION_Z_MAX);
        const int32_t reach = z < SLOPE_Z_MAX ? (int32_t)z : SLOPE_Z_MAX;
        uint32_t cost = component->cost + labial_z_cost(z);
        if (model->contexts) {
            const uint8_t *context = model->contexts + (size_t)index * model->class_count;
            cost += (context[previous_class] & 15u) * 16u + (context[next_class] & 0xf0u);
        }
        costs[c] = cost;
        deviations[c] = distance < 0 ? -reach : reach;
        if (cost < least) {
            least = cost;
            best = c;
        }
    }
    return best;
}

/* Picks the components of a phoneme's shape: the best alone, or all weighted by likelihood, the best taking the
 * rounding remainder. */
static void select_components(const labial_model_t *model, const labial_spoken_t *spoken, labial_selection_t *selection)
{
    const unsigned count = model->phonemes[spoken->phoneme].component_count;
    uint32_t parts[LABIAL_PHONEME_COMPONENTS_MAX];     /* costs; then likelihoods, of the mixture */
    int32_t deviations[LABIAL_PHONEME_COMPONENTS_MAX]; /* z of the duration, Q6, not beyond +-SLOPE_Z_MAX */
    const unsigned best = score(model, spoken, parts, deviations);
    const uint32_t least = parts[best];
    uint32_t sum = likelihood(0), rest = ONE, inverse; /* that of the best one, whose share comes last */
    unsigned i, counting = 0;
    for (i = 0; i < count; i++) {
        parts[i] = model->mixture_mean && i != best ? likelihood(parts[i] - least) : 0u;
        sum += parts[i];
    }
    inverse = labial_quotient(0x80000000u, sum);
    for (i = 0; i <= count; i++) {
        const unsigned c = i < count ? i : best;
        const uint16_t share = (uint16_t)(i < count ? likelihood_share(parts[i], sum, inverse) : rest); /* Q12 */
        rest -= share;
        if (share > 0) {
            /* The best one's likelihood is counted in the sum alone, and so it comes once. */
            /*@ assert counting < 8; */
            LABIAL_CHECK(counting < LABIAL_PHONEME_COMPONENTS_MAX);
            selection->components[counting] = (uint8_t)c;
            selection->shares[counting] = share;
            selection->tilts[counting++] = (int16_t)((share * deviations[c]) >> 6);
        }
    }
    selection->count = (uint8_t)counting;
}

/* Mixes every other channel of a phoneme's shape, the same at both knots. */
static void mix(const labial_model_t *model, const labial_phoneme_t *phoneme, labial_selection_t *selection)
{
    const unsigned count = selection->count, width = model->channel_count;
    unsigned c, k;
    for (k = selection->halves; k < width; k += 2u) {
        const labial_channel_t *channel = &model->channels[k];
        int32_t mean = 0, change = 0; /* in table steps, Q12 */
        for (c = 0; c < count; c++) {
            const size_t at = ((size_t)phoneme->first_component + selection->components[c]) * width + k;
            mean += (int32_t)selection->shares[c] * model->shapes[at];
            if (model->slopes)
                change += selection->tilts[c] * model->slopes[at];
        }
        /* The shares add up to one, and so the tilts to 136 / 64 at most. */
        /*@ assert -524288 <= mean <= 524288; */
        /*@ assert -1118208 <= change <= 1118208; */
        LABIAL_CHECK(labial_clamp(mean, 524288) == mean && labial_clamp(change, 1118208) == change);
        mean = ((mean >> 4) * channel->shape_scale + 32768) >> 16;
        change = ((change >> 4) * channel->slope_scale + 32768) >> 16;
        selection->shape[k].knots[0] = selection->shape[k].knots[1] = labial_position(mean + change);
    }
}

/* Adds what a neighbour adds to the shape of a phoneme; nothing for pairs that the model does not know. `key` is theirs
 * in `pair_keys`. */
static void add_pair(const labial_model_t *model, unsigned key, labial_shape_t *shape)
{
    const unsigned knots = model->pair_knots, width = model->channel_count;
    const int8_t *start, *end;
    unsigned low = 0, high = model->pair_count, middle, k;
    do {
        if (low >= high)
            return;
        middle = (low + high) / 2u;
        if (model->pair_keys[middle] < key)
            low = middle + 1u;
        else
            high = middle;
    } while (model->pair_keys[middle] != key);
    start = model->pairs + (size_t)middle * knots * width;
    end = knots > 1u ? start + width : start;
    for (k = 0; k < width; k++) {
        const uint16_t scale = model->channels[k].pair_scale;
        int16_t *const knot = shape[k].knots;
        knot[0] = labial_position(knot[0] + labial_scaled(start[k], scale));
        knot[1] = labial_position(knot[1] + labial_scaled(end[k], scale));
    }
}

void labial_shape_select(const labial_model_t *model, const labial_spoken_t *spoken, labial_selection_t *selection)
{
    if (selection->halves == 0)
        select_components(model, spoken, selection);
    mix(model, &model->phonemes[spoken->phoneme], selection);
    if (selection->halves++ > 0) {
        add_pair(model, spoken->phoneme * 256u + spoken->previous, selection->shape);
        add_pair(model, spoken->phoneme * 256u + 128u + spoken->next, selection->shape);
    }
}

/* The channels in which a phoneme makes contact, or silence comes to rest. */
static unsigned contacts_of(const labial_model_t *model, unsigned phoneme)
{
    const unsigned floor = model->phonemes[phoneme].floor;
    return floor ? model->contacts[floor - 1u] : 0u;
}

/* The floors of a phoneme, null without any. */
static const int16_t *floors_of(const labial_model_t *model, unsigned phoneme)
{
    const unsigned floor = model->phonemes[phoneme].floor;
    return floor ? model->floors + (floor - 1u) * model->channel_count : NULL;
}

/* Raises those of the channels to a phoneme's floor that lie below it. */
static void apply_floor(const labial_model_t *model, unsigned phoneme, unsigned channels,
                        int16_t target[LABIAL_CHANNELS])
{
    const int16_t *least = floors_of(model, phoneme);
    unsigned left;
    if (least)
        for (left = model->channel_count; left > 0; left--, target++, least++, channels >>= 1)
            if ((channels & 1u) && *target < *least)
                *target = *least;
}

/* Brings the channels `rest` of LABIAL_REST_FRAMES of the way to the floor of silence. */
static void come_to_rest(const labial_model_t *model, unsigned channels, int16_t target[LABIAL_CHANNELS], int32_t rest)
{
    const int16_t *const floors = floors_of(model, model->silence);
    unsigned k;
    for (k = 0; channels > 0; k++, channels >>= 1)
        if (channels & 1u) {
            /* Only phonemes with floors make contact, in channels that the model has. */
            /*@ assert floors != \null && k < 13; */
            LABIAL_CHECK(floors && k < model->channel_count);
            target[k] = (int16_t)(target[k] + (floors[k] - target[k]) * rest / LABIAL_REST_FRAMES);
        }
}

/* The label of the nearest phoneme that makes contact, forwards (`step` is 1) or backwards (-1); null where there is
 * none within LABIAL_CONTACT_FRAMES, or silence is nearer. */
static const uint8_t *nearest_contact(const labial_model_t *model, const uint8_t *label, int step)
{
    unsigned distance;
    for (distance = 1; distance <= LABIAL_CONTACT_FRAMES; distance++) {
        label += step;
        if (*label == model->silence)
            break;
        if (contacts_of(model, *label))
            return label;
    }
    return NULL;
}

/* Parts the lips in a frame between two contacts that are LABIAL_CONTACT_FRAMES or less apart, in the channels that
 * both have. */
static void part(const labial_model_t *model, const uint8_t *label, int16_t target[LABIAL_CHANNELS])
{
    const uint8_t *const ahead = nearest_contact(model, label, 1), *behind;
    const int16_t *last, *next;
    unsigned channels, fap;
    if (!ahead)
        return;
    behind = nearest_contact(model, label, -1);
    if (!behind || ahead - behind > LABIAL_CONTACT_FRAMES + 1)
        return;
    channels = contacts_of(model, *behind) & contacts_of(model, *ahead);
    last = floors_of(model, *behind);
    next = floors_of(model, *ahead);
    /* Only phonemes with floors make contact. */
    /*@ assert last != \null && next != \null; */
    LABIAL_CHECK(last && next);
    for (fap = 0; fap < LABIAL_CHANNELS; fap++) {
        const unsigned k = model->sources[fap];
        if (parted[fap] && (channels >> k & 1u)) { /* FAP 17, which may have no channel, does not part */
            const int32_t one = last[k], other = next[k], floor = one < other ? one : other;
            const int16_t most = labial_position(floor - parted[fap] * 16);
            if (floor > LABIAL_NO_FLOOR && target[k] > most)
                target[k] = most;
        }
    }
}

/* Contact of a phoneme and of short ones beside it, and lips that part between two; returns the channels in contact. */
static unsigned touch(const labial_model_t *model, const labial_taken_t *taken, int16_t target[LABIAL_CHANNELS])
{
    const uint8_t *labels = taken->labels;
    const unsigned own = contacts_of(model, labels[0]);
    const unsigned apart = taken->is_open || labels[0] == model->silence ? own : 0u; /* not in this frame */
    unsigned borrowed = 0;
    int step;
    apply_floor(model, labels[0], ~apart, target);
    if (taken->rest)
        come_to_rest(model, own, target, taken->rest);
    for (step = -1; step < 2; step += 2) { /* a short contact has the frame before it, and one frame's that after it */
        const unsigned beside = labels[step];
        if (beside != labels[0] && beside != model->silence &&
            (beside != labels[2 * step] || (step > 0 && beside != labels[3]))) {
            const unsigned contacts = contacts_of(model, beside);
            apply_floor(model, beside, contacts, target);
            borrowed |= contacts;
        }
    }
    if (!(own | borrowed) && labels[0] != model->silence)
        part(model, labels, target);
    return (own & ~apart) | borrowed;
}

/* Where the kernels' taps of a frame begin. */
static void find_taps(const labial_model_t *model, const uint8_t *labels, const uint32_t **words)
{
    const unsigned taps = model->kernel_taps, size = LABIAL_KERNEL_WORDS((unsigned)model->channel_count);
    int lag = -(int)(model->kernel_behind * model->kernel_stride); /* an index, for no pointer may pass the end */
    unsigned tap;
    for (tap = 0; tap < taps; tap++, lag += model->kernel_stride)
        words[tap] = model->kernels + ((size_t)labels[lag] * taps + tap) * size;
}

/* What the words of the taps add up to on the four channels of word `group`. Two channels of a word are summed at once;
 * with them the sum of the words, modulo 2^32, tells the other two. */
static void add_taps(const uint32_t *const *words, unsigned taps, unsigned group, uint16_t sums[4])
{
    const uint32_t halves = 0x00ff00ffu;
    const uint32_t *const *const end = words + taps;
    uint32_t even = 0, odd = 0;
    for (; words < end; words++) {
        const uint32_t word = (*words)[group];
        even += word;
        odd += word >> 8 & halves;
    }
    even -= odd << 8;
    sums[0] = (uint16_t)even;
    sums[1] = (uint16_t)odd;
    sums[2] = (uint16_t)(even >> 16);
    sums[3] = (uint16_t)(odd >> 16);
}

unsigned labial_shape_target(const labial_model_t *model, const labial_shape_t *shape, const labial_taken_t *taken,
                             int16_t target[LABIAL_CHANNELS])
{
    const uint32_t *words[LABIAL_KERNEL_TAPS_MAX]; /* of each tap's phoneme */
    uint16_t sums[4u * LABIAL_KERNEL_WORDS(LABIAL_CHANNELS)];
    const labial_channel_t *const channels = model->channels;
    const int32_t share = taken->share, bias = model->kernel_taps * 128; /* of each sum */
    const unsigned width = model->channel_count;
    unsigned group, k;
    find_taps(model, taken->labels, words);
    /* The prover looks at each width by itself, to see that all sums that are read were written. */
    /*@ split width; */
    for (group = 0; group < LABIAL_KERNEL_WORDS(width); group++)
        add_taps(words, model->kernel_taps, group, sums + 4u * group);
    for (k = 0; k < width; k++) {
        const int32_t start = shape[k].knots[0];
        const int32_t position = start + (((shape[k].knots[1] - start) * share + 8192) >> 14) +
                                 labial_scaled((int16_t)(sums[k] - bias), channels[k].kernel_scale);
        target[k] = labial_position(position);
    }
    /*@ merge width; */
    return model->floor_count ? touch(model, taken, target) : 0u;
}
