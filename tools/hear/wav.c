/*
 * wav.c - chunks, the format, samples.
 */
#include "wav.h"

#include <inttypes.h>
#include <string.h>

/* Bytes of a format that matter here: those of WAVE_FORMAT_EXTENSIBLE up to the number of the encoding. */
#define FORMAT_BYTES 26u
#define FORMAT_BYTES_MIN 16u

/* Encodings. */
#define PCM 1u
#define FLOATING 3u
#define A_LAW 6u
#define MU_LAW 7u
#define EXTENSIBLE 0xfffeu

/* Programs that write into a pipe do not know the size of the sound, and write the largest that their like accepts, or
 * 0. */
#define SIZE_UNKNOWN 0x7ffff000u

static uint32_t little_endian(const unsigned char *at, unsigned bytes)
{
    uint32_t value = 0;
    for (unsigned i = 0; i < bytes; i++)
        value |= (uint32_t)at[i] << 8 * i;
    return value;
}

/* ---- Samples ----------------------------------------------------------------------------------------------------- */

static int16_t of_number(double number, int *wrong)
{
    const double scaled = 32767.0 * number;
    if (!(scaled - scaled >= 0.0)) { /* infinite, or no number */
        *wrong = 1;
        return 0;
    }
    return (int16_t)(scaled < -32768.0 ? -32768.0 : scaled > 32767.0 ? 32767.0 : scaled + (scaled < 0.0 ? -0.5 : 0.5));
}

static double floating(const unsigned char *at, unsigned bytes)
{
    const uint32_t low = little_endian(at, 4);
    float number;
    double wide;
    if (bytes == 8) {
        const uint64_t bits = (uint64_t)little_endian(at + 4, 4) << 32 | low;
        memcpy(&wide, &bits, sizeof wide);
        return wide;
    }
    memcpy(&number, &low, sizeof number);
    return (double)number;
}

/* ITU-T G.711. */
static int of_a_law(unsigned byte)
{
    const unsigned code = byte ^ 0x55u, segment = code >> 4 & 7u;
    const int step = (int)((code & 15u) << 4) + 8;
    const int size = segment == 0 ? step : (step + 256) * (1 << (segment - 1));
    return code & 0x80u ? size : -size;
}

static int of_mu_law(unsigned byte)
{
    const unsigned code = ~byte;
    const int size = (((int)(code & 15u) << 3) + 132) * (1 << (code >> 4 & 7u)) - 132;
    return code & 0x80u ? -size : size;
}

/* A sample of a file as 16 bits; `wrong` is set where it is no number. */
static int16_t sample_of(const wav_t *wav, const unsigned char *at, int *wrong)
{
    switch (wav->encoding) {
    case FLOATING:
        return of_number(floating(at, wav->bytes), wrong);
    case A_LAW:
        return (int16_t)of_a_law(*at);
    case MU_LAW:
        return (int16_t)of_mu_law(*at);
    default: /* PCM */
        return wav->bytes == 1 ? (int16_t)((*at - 128) * 256)
                               : (int16_t)(uint16_t)little_endian(at + wav->bytes - 2, 2);
    }
}

static int is_known(unsigned encoding, unsigned bits)
{
    static const unsigned kinds[][2] = { { PCM, 8 },       { PCM, 16 },      { PCM, 24 },  { PCM, 32 },
                                         { FLOATING, 32 }, { FLOATING, 64 }, { A_LAW, 8 }, { MU_LAW, 8 } };
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (kinds[i][0] == encoding && kinds[i][1] == bits)
            return 1;
    return 0;
}

/* ---- The file ------------------------------------------------------------------------------------------------------ */

static int failed(wav_t *wav, const char *why)
{
    (void)snprintf(wav->message, sizeof wav->message, "%s", ferror(wav->in) ? "cannot read" : why);
    return -1;
}

static int read_all(wav_t *wav, unsigned char *bytes, size_t count, const char *why)
{
    wav->place += (uint32_t)count;
    return fread(bytes, 1, count, wav->in) == count ? 0 : failed(wav, why);
}

/* Passes over `count` bytes of a chunk, by reading, as a pipe cannot seek. */
static int skip(wav_t *wav, uint32_t count)
{
    unsigned char bytes[512];
    while (count > 0) {
        const uint32_t part = count < sizeof bytes ? count : (uint32_t)sizeof bytes;
        if (read_all(wav, bytes, part, "a chunk is longer than the file") != 0)
            return -1;
        count -= part;
    }
    return 0;
}

static int read_format(wav_t *wav, uint32_t size)
{
    unsigned char format[FORMAT_BYTES] = { 0 };
    const uint32_t taken = size < FORMAT_BYTES ? size : FORMAT_BYTES;
    if (size < FORMAT_BYTES_MIN)
        return failed(wav, "its format has less than 16 bytes");
    if (read_all(wav, format, taken, "ends within its format") != 0)
        return -1;
    const unsigned bits = little_endian(format + 14, 2);
    wav->encoding = little_endian(format, 2);
    if (wav->encoding == EXTENSIBLE && size >= FORMAT_BYTES)
        wav->encoding = little_endian(format + 24, 2);
    wav->channels = little_endian(format + 2, 2);
    wav->rate = little_endian(format + 4, 4);
    if (!is_known(wav->encoding, bits)) {
        (void)snprintf(wav->message, sizeof wav->message,
                       "has samples of %u bits in encoding %u, not PCM, floating point, A-law or mu-law", bits,
                       wav->encoding);
        return -1;
    }
    wav->bytes = bits / 8u;
    if (wav->channels < 1 || wav->channels > 2) {
        (void)snprintf(wav->message, sizeof wav->message, "has %u channels, not 1 or 2", wav->channels);
        return -1;
    }
    if (little_endian(format + 12, 2) != wav->bytes * wav->channels)
        return failed(wav, "its format contradicts itself: bytes of a sample");
    return skip(wav, size - taken) == 0 && skip(wav, size & 1u) == 0 ? 0 : -1;
}

/* Reads the chunks behind the first bytes. */
static int read_chunks(wav_t *wav)
{
    unsigned char head[8];
    wav->last = 0;
    wav->place = WAV_HEAD - 8u; /* of what the size of the file counts */
    wav->riff = little_endian(wav->head + 4, 4);
    for (;;) {
        if (read_all(wav, head, 8, "ends before its samples") != 0)
            return -1;
        const uint32_t size = little_endian(head + 4, 4);
        if (memcmp(head, "data", 4) == 0) {
            const int behind = wav->riff <= wav->place || wav->riff >= SIZE_UNKNOWN; /* no other chunk is */
            wav->left = wav->size = size;
            wav->endless = size >= SIZE_UNKNOWN || (size == 0 && behind);
            return wav->channels > 0 ? 0 : failed(wav, "has no format before its samples");
        }
        if (memcmp(head, "fmt ", 4) == 0) {
            if (read_format(wav, size) != 0)
                return -1;
        } else if (skip(wav, size) != 0 || skip(wav, size & 1u) != 0) {
            return -1;
        }
    }
}

int wav_open(wav_t *wav, FILE *in, uint32_t rate, unsigned channels)
{
    memset(wav, 0, sizeof *wav);
    wav->in = in;
    wav->last = (unsigned)fread(wav->head, 1, WAV_HEAD, in);
    if (wav->last == WAV_HEAD && memcmp(wav->head + 8, "WAVE", 4) == 0) {
        if (memcmp(wav->head, "RIFF", 4) == 0)
            return read_chunks(wav);
        if (memcmp(wav->head, "RF64", 4) == 0 || memcmp(wav->head, "BW64", 4) == 0) /* sizes of 64 bits */
            return failed(wav, "is an RF64 or BW64 file; convert it to a WAV file of less than 4 GB");
    }
    if (rate == 0)
        return failed(wav, "is not a WAV file");
    wav->rate = rate;
    wav->channels = channels;
    wav->bytes = 2;
    wav->encoding = PCM;
    wav->endless = 1;
    return 0;
}

/* Reads bytes of samples, beginning with those that were kept. */
static size_t read_bytes(wav_t *wav, unsigned char *bytes, size_t count)
{
    const size_t left = wav->last - wav->first, kept = count < left ? count : left;
    memcpy(bytes, wav->head + wav->first, kept);
    wav->first += (unsigned)kept;
    return kept + fread(bytes + kept, 1, count - kept, wav->in);
}

long wav_read(wav_t *wav, int16_t *samples, size_t count)
{
    unsigned char bytes[480];
    const size_t size = (size_t)wav->bytes * wav->channels; /* divides 480 */
    size_t read = 0;
    int wrong = 0;
    while (read < count) {
        size_t wanted = (count - read) * size < sizeof bytes ? (count - read) * size : sizeof bytes;
        if (!wav->endless && wanted > wav->left)
            wanted = wav->left;
        const size_t got = read_bytes(wav, bytes, wanted);
        if (ferror(wav->in))
            return failed(wav, "");
        if (!wav->endless)
            wav->left -= (uint32_t)got;
        if (!wav->endless && got < wanted) {
            wav->cut = wav->left;
            wav->left = 0;
        }
        for (size_t i = 0; i < got / size * wav->channels; i++)
            samples[read * wav->channels + i] = sample_of(wav, bytes + wav->bytes * i, &wrong);
        if (wrong)
            return failed(wav, "a sample is not finite");
        read += got / size;
        if (got < size || (!wav->endless && wav->left == 0) || got < wanted)
            break;
    }
    return (long)read;
}

double wav_seconds(const wav_t *wav, uint32_t bytes)
{
    return (double)bytes / (double)(wav->bytes * wav->channels) / (double)wav->rate;
}
