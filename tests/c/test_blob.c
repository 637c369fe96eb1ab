/*
 * test_blob.c - models as blobs: the serialiser of the fixture writes them from the description in labial/blob.h.
 */
#include "suite.h"
#include "labial/blob.h"

#define ROOM 65536

static fixture_model_t plain, rich, slow, laugh, computed;
static const labial_model_t *models[5];
static fixture_phoneme_t input[40];
static uint32_t written[ROOM / 4];
static uint8_t *const bytes = (uint8_t *)written;

SETUP(setup)
{
    fixture_all(&plain, &rich, &laugh, &slow);
    models[0] = &plain.model;
    models[1] = &rich.model;
    fixture_rich(&computed);
    fixture_narrow(&computed, fixture_mirrored);
    models[2] = &computed.model;
    for (unsigned c = 0; c < LABIAL_CHANNELS; c++)
        rich.channels[c].contact_weight = (uint8_t)(0x21 + c);
    slow.model.pair_knots = 1;
    models[3] = &slow.model;
    models[4] = &laugh.model;
    return 0;
}

static size_t serialise(const labial_model_t *model)
{
    const size_t size = fixture_serialise(model, bytes, ROOM);
    assert_true(size > 100 && size <= ROOM && size % 4 == 0);
    return size;
}

/* Loads a copy of the first `size` bytes, which is to be freed. */
static int load(labial_blob_t *blob, size_t size, void **copy)
{
    *copy = fixture_copy(bytes, size);
    return labial_model_load(blob, *copy, size);
}

/* Would catch a table at the wrong place, a wrong pad, a scale, a weight or a table of contact that is not read, and
 * pairs of two knots taken for such of one. */
TEST(a_blob_gives_the_same_frames)
{
    for (unsigned m = 0; m < 5; m++) {
        labial_blob_t blob;
        fixture_host_t wanted, host;
        void *copy;
        memset(&blob, 0xee, sizeof blob);
        assert_ok(load(&blob, serialise(models[m]), &copy));
        fixture_stream(input, 40, FIXTURE_RANDOM, m);
        for (unsigned i = 0; i < 40; i++)
            input[i].phoneme = (uint8_t)(input[i].phoneme % models[m]->phoneme_count);
        assert_played(&wanted, fixture_run(&wanted, models[m], input, 40, FIXTURE_FILL));
        assert_played(&host, fixture_run(&host, &blob.model, input, 40, FIXTURE_FILL));
        assert_int_equal(fixture_difference(&wanted.recorder, &host.recorder), -1);
        assert_memory_equal(copy, bytes, 64); /* used in place and never written */
        fixture_close(&wanted);
        fixture_close(&host);
        free(copy);
    }
}

/* Would catch a size that is not compared with what the tables take: the model that was meant is another one. */
TEST(surplus_bytes_are_refused)
{
    const size_t size = serialise(&rich.model);
    labial_blob_t blob;
    memset(bytes + size, 0, 4);
    fixture_seal(bytes, size + 4);
    assert_int_equal(labial_model_load(&blob, bytes, size + 4), LABIAL_ERROR_MODEL);
    fixture_seal(bytes, size);
    assert_ok(labial_model_load(&blob, bytes, size));
}

/* As it is, and with a size and a checksum that fit what is left: every length must be checked before it is relied on. */
TEST(every_truncation_is_refused)
{
    for (unsigned m = 0; m < 3; m++) {
        const size_t size = serialise(models[m]);
        for (size_t n = 0; n < size; n += n < 64 ? 1 : LABIAL_TEST_SHARE) { /* each that may end within the header */
            for (int sealed = 0; sealed < (n < 12 ? 1 : 2); sealed++) {
                uint8_t head[12];
                labial_blob_t blob;
                void *copy;
                memcpy(head, bytes, sizeof head);
                if (sealed)
                    fixture_seal(bytes, n);
                const int result = load(&blob, n, &copy);
                memcpy(bytes, head, sizeof head);
                if (result != LABIAL_ERROR_MODEL)
                    fail_msg("%zu of %zu bytes give %d", n, size, result);
                free(copy);
            }
        }
    }
}

/* Would catch bytes that the checksum does not cover, and a checksum that is not compared in full. */
TEST(every_damaged_byte_is_refused)
{
    static const uint8_t flips[] = { 0x01, 0x80, 0xff };
    const size_t size = serialise(&rich.model);
    labial_blob_t blob;
    assert_ok(labial_model_load(&blob, bytes, size));
    for (size_t n = 0; n < size; n += n < 64 ? 1 : LABIAL_TEST_SHARE) { /* each of the header */
        for (unsigned i = 0; i < sizeof flips; i++) {
            bytes[n] ^= flips[i];
            const int result = labial_model_load(&blob, bytes, size);
            bytes[n] ^= flips[i];
            if (result != LABIAL_ERROR_MODEL && result != LABIAL_ERROR_VERSION)
                fail_msg("byte %zu ^ %u gives %d", n, flips[i], result);
        }
    }
    assert_ok(labial_model_load(&blob, bytes, size));
}

/* Would catch a value that passes the check and then leads outside of memory: what is accepted must play. */
TEST(damage_that_is_sealed_is_refused_or_plays)
{
    const size_t size = serialise(&rich.model);
    unsigned refused = 0, played = 0;
    for (size_t n = 12; n < size; n += LABIAL_TEST_SHARE) {
        static const uint8_t values[] = { 0x00, 0xff, 0x80, 0x7f };
        const uint8_t was = bytes[n];
        labial_blob_t blob;
        void *copy;
        bytes[n] = n % 5 == 4 ? (uint8_t)(was ^ 1u) : values[(n + n / 5) % 4];
        fixture_seal(bytes, size);
        const int result = load(&blob, size, &copy);
        bytes[n] = was;
        if (result == LABIAL_OK) {
            fixture_host_t host;
            fixture_stream(input, 8, FIXTURE_ONE_FRAME, (uint32_t)n);
            for (unsigned i = 0; i < 8; i++) {
                input[i].phoneme = (uint8_t)(input[i].phoneme % blob.model.phoneme_count);
                input[i].ms = i * 16;
            }
            if (fixture_run(&host, &blob.model, input, 8, FIXTURE_FILL) != 0)
                fail_msg("byte %zu: %s", n, host.complaint);
            assert_true(
                fixture_is_exact(host.recorder.count, fixture_duration(input, 8), blob.model.frames_per_second));
            fixture_close(&host);
            played++;
        } else {
            assert_true(result == LABIAL_ERROR_MODEL || result == LABIAL_ERROR_VERSION);
            refused++;
        }
        free(copy);
    }
    assert_true(refused > FIXTURE_ROUNDS(100) && played > FIXTURE_ROUNDS(100)); /* both ways were taken */
}

TEST(misaligned_data_is_refused)
{
    const size_t size = serialise(&plain.model);
    labial_blob_t blob;
    for (unsigned shift = 1; shift < 4; shift++) {
        memmove(bytes + shift, bytes + shift - 1, size);
        assert_int_equal(labial_model_load(&blob, bytes + shift, size), LABIAL_ERROR_MODEL);
    }
    memmove(bytes + 4, bytes + 3, size);
    assert_ok(labial_model_load(&blob, bytes + 4, size));
}

TEST(other_formats_are_refused)
{
    static const uint8_t formats[][2] = { { LABIAL_MODEL_FORMAT + 1, 0 },
                                          { LABIAL_MODEL_FORMAT - 1, 0 },
                                          { 0, 0 },
                                          { LABIAL_MODEL_FORMAT, 1 },
                                          { 0xff, 0xff } };
    const size_t size = serialise(&plain.model);
    labial_blob_t blob;
    for (unsigned i = 0; i < 5; i++) {
        memcpy(bytes + 12, formats[i], 2);
        fixture_seal(bytes, size);
        assert_int_equal(labial_model_load(&blob, bytes, size), LABIAL_ERROR_VERSION);
    }
    (void)serialise(&plain.model);
    memcpy(bytes, "LBM2", 4); /* not covered by the checksum */
    assert_true(labial_model_load(&blob, bytes, size) < 0);
    memcpy(bytes, "1MBL", 4);
    assert_true(labial_model_load(&blob, bytes, size) < 0);
}

TEST(null_is_refused)
{
    const size_t size = serialise(&plain.model);
    labial_blob_t blob;
    assert_int_equal(labial_model_load(NULL, bytes, size), LABIAL_ERROR_NULL);
    assert_int_equal(labial_model_load(&blob, NULL, size), LABIAL_ERROR_NULL);
    assert_int_equal(labial_model_load(&blob, bytes, 0), LABIAL_ERROR_MODEL);
}

/* Would catch a checksum of another polynomial or bit order: this one's check value is that of zlib and PNG. */
TEST(the_serialisers_checksum_is_the_known_one)
{
    assert_int_equal(fixture_crc32((const uint8_t *)"123456789", 9), 0xcbf43926u);
}

/* Counts that contradict the tables' true lengths, with everything else intact. */
TEST(counts_that_lie_are_refused)
{
    static const struct {
        unsigned at;
        uint8_t value;
    } lies[] = {
        { 16, 0 },   { 17, 0xff }, { 18, 1 },   { 18, 7 },
        { 18, 255 }, { 19, 1 },    { 19, 32 },  { 20, 1 },
        { 20, 64 },  { 20, 255 },  { 21, 0 },   { 21, 4 },
        { 21, 7 },   { 21, 12 },   { 21, 64 },  { 21, 255 },
        { 22, 0 },   { 22, 9 },    { 22, 255 }, { 23, 6 },
        { 24, 2 },   { 25, 0 },    { 25, 8 },   { 26, 255 },
        { 27, 7 },   { 28, 0 },    { 28, 1 },   { 28, 2 },
        { 28, 3 },   { 28, 8 },    { 28, 15 },  { 28, 16 },
        { 28, 255 }, { 29, 0 },    { 29, 1 },   { 29, 5 },
        { 29, 255 }, { 30, 0 },    { 30, 1 },   { 30, 35 },
        { 30, 37 },  { 30, 255 },  { 31, 1 },   { 35, LABIAL_FROM_CORNERS }, /* without the table that this needs */
    };
    for (unsigned i = 0; i < COUNT_OF(lies); i++) {
        const size_t size = serialise(&rich.model);
        labial_blob_t blob;
        void *copy;
        bytes[lies[i].at] = lies[i].value;
        fixture_seal(bytes, size);
        if (load(&blob, size, &copy) != LABIAL_ERROR_MODEL)
            fail_msg("byte %u = %u is accepted", lies[i].at, lies[i].value);
        free(copy);
    }
}

static int is_big_endian(void)
{
    const uint16_t one = 1;
    return *(const uint8_t *)&one == 0;
}

/* Would catch a blob that is played with every number's bytes in the wrong order. */
static void every_blob_is_refused(void **state)
{
    (void)state;
    assert_int_equal(labial_model_load(NULL, bytes, 0), LABIAL_ERROR_NULL);
    for (unsigned m = 0; m < 5; m++) {
        const size_t size = serialise(models[m]);
        labial_blob_t blob;
        void *copy;
        assert_int_equal(load(&blob, size, &copy), LABIAL_ERROR_VERSION);
        free(copy);
    }
}

/* A blob is little-endian and used in place. */
int SUITE_MAIN(void);
int SUITE_MAIN(void)
{
    const struct CMUnitTest elsewhere[] = { cmocka_unit_test(the_serialisers_checksum_is_the_known_one),
                                            cmocka_unit_test(every_blob_is_refused) };
    return is_big_endian() ? cmocka_run_group_tests(elsewhere, setup, NULL)
                           : cmocka_run_group_tests(suite, setup, NULL);
}
