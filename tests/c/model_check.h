/*
 * model_check.h - one change to a model that is accepted, and what labial_model_check() says of it. For suites that have
 * a fixture_model_t `f` and cmocka.
 */
#ifndef LABIAL_TEST_MODEL_CHECK_H
#define LABIAL_TEST_MODEL_CHECK_H

/* Sets `place` to a value, wants `expected` from the check, and puts the old value back. */
#define TRY(type, place, value, expected)                                                                              \
    do {                                                                                                               \
        type const old_ = (place);                                                                                     \
        int got_;                                                                                                      \
        (place) = (type)(value);                                                                                       \
        got_ = labial_model_check(&f.model);                                                                           \
        (place) = old_;                                                                                                \
        if (got_ != (expected))                                                                                        \
            fail_msg("%s = %s gives %d, not %s", #place, #value, got_, #expected);                                     \
    } while (0)

#define REFUSED(type, place, value) TRY(type, place, value, LABIAL_ERROR_MODEL)
#define ACCEPTED(type, place, value) TRY(type, place, value, LABIAL_OK)

#endif
