/* test_lens.c: refocus/lens.h against Potmesil & Chakravarty 1981, Table 1, against the
 * reference scenes, and against itself. */
#include <math.h>
#include <stdint.h>
#include "unit_test.h"
#include <refocus/lens.h>

static void assert_close(double value, double expected, double relative)
{
    if (!(fabs(value - expected) <= relative * fabs(expected)))
        fail_msg("%.17g should be %.17g", value, expected);
}

static const struct {
    double f_number, diameter_mm, u, far, near, field; /* mm */
} table1[] = {
    {5.6, 9.82, 2000, 2511, 1662, 849},  {5.6, 9.82, 980, 1089, 891, 198},
    {5.6, 9.82, 550, 583, 521, 62},      {5.6, 9.82, 290, 299, 282, 17},
    {11, 5.00, 2000, 3333, 1429, 1904},  {11, 5.00, 980, 1219, 819, 400},
    {11, 5.00, 550, 618, 495, 123},      {11, 5.00, 290, 308, 274, 34},
    {22, 2.50, 2000, 10000, 1111, 8889}, {22, 2.50, 980, 1612, 704, 908},
    {22, 2.50, 550, 705, 451, 254},      {22, 2.50, 290, 328, 260, 68},
};

/* All 12 rows, as printed: rounded to millimetres, the field from the rounded limits. */
TEST(test_potmesil_table)
{
    for (size_t i = 0; i < sizeof table1 / sizeof *table1; i++) {
        const struct refocus_lens lens = {55, table1[i].f_number, 36};
        const double h = refocus_hyperfocal_m(&lens, 1000);
        const struct refocus_depth_of_field field = refocus_depth_of_field_m(table1[i].u / 1000, h);
        const double near = floor(field.near_m * 1000 + 0.5);
        const double far = floor(field.far_m * 1000 + 0.5);

        /* The table truncates diameters and keeps two places. */
        assert_true(fabs(2000 * refocus_aperture_radius_m(&lens) - table1[i].diameter_mm) < 0.01);
        if (near != table1[i].near || far != table1[i].far || far - near != table1[i].field)
            fail_msg("f/%g, U = %g: %g %g %g", table1[i].f_number, table1[i].u, far, near,
                     far - near);
    }
}

TEST(test_hyperfocal)
{
    const struct refocus_lens lens = {50, 8, 36};
    const double h = refocus_hyperfocal_m(&lens, 1000);

    assert_close(h, 6.25, 1e-15);
    assert_true(isinf(refocus_depth_of_field_m(h, h).far_m));
    assert_close(refocus_depth_of_field_m(h, h).near_m, h / 2, 1e-15);
    assert_true(isinf(refocus_depth_of_field_m(2 * h, h).far_m));
    assert_true(isfinite(refocus_depth_of_field_m(h * 0.999, h).far_m));
    assert_close(refocus_depth_of_field_m(INFINITY, h).near_m, h, 1e-15);
    assert_true(isinf(refocus_depth_of_field_m(INFINITY, h).far_m));
}

/* z0, z1 and every reference of scenes whose scene.json states df, zf, K, R and N. */
static const struct {
    double z0, z1, width, df, zf, k, radius, f_number;
} references[] = {
    {0.6483874917030334, 9.399999618530273, 720, 0.776850473117309, 0.8184202313423157, 20,
     0.01392850159797451, 1.7948807934685176},
    {0.6483874917030334, 9.399999618530273, 720, 0.24306415953599203, 2.1958720684051514, 40,
     0.02785700319594902, 0.8974403967342588},
    {0.6483874917030334, 9.399999618530273, 720, 0.0, 9.399999618530273, 10, 0.006964250798987255,
     3.589761586937035},
    {1.1800146102905273, 16.5, 720, 0.2936721894760874, 3.42842173576355, 10, 0.012709046761148991,
     1.9671026843983237},
    {1.1800146102905273, 16.5, 720, 0.9663542422301963, 1.2180664539337158, 20,
     0.025418093522297982, 0.9835513421991618},
    {1.1800146102905273, 16.5, 720, 0.002407016432035792, 16.0, 20, 0.025418093522297982,
     0.9835513421991618},
    {0.7800515294075012, 14.0, 720, 0.6885581720004893, 1.1050280332565308, 40,
     0.033043158786883124, 0.7565862622650971},
    {0.7800515294075012, 14.0, 720, 0.2573259998390012, 2.611433267593384, 20, 0.016521579393441562,
     1.5131725245301941},
    {0.7794885039329529, 14.0, 1920, 0.6880645202011408, 1.1049797534942627, 20,
     0.006190856755981673, 4.038213285397814},
    {0.8320308327674866, 4.2147979736328125, 720, 0.9159354417855128, 0.8922291994094849, 20,
     0.020733569423589462, 1.2057740512136053},
    {0.8320308327674866, 4.2147979736328125, 720, 0.34737320214452183, 1.7472065687179565, 40,
     0.041467138847178925, 0.6028870256068026},
    {0.8320308327674866, 4.2147979736328125, 720, 0.0325204461294999, 3.722604274749756, 10,
     0.010366784711794731, 2.4115481024272105},
};

TEST(test_reference_scenes)
{
    for (size_t i = 0; i < sizeof references / sizeof *references; i++) {
        const struct refocus_lens lens = {50, references[i].f_number, 36};
        const struct refocus_depth_range range = {references[i].z0, references[i].z1};
        const double width = references[i].width;

        assert_close(refocus_focal_length_px(&lens, width), width / 36 * 50, 1e-14);
        assert_close(refocus_aperture_radius_m(&lens), references[i].radius, 1e-6);
        assert_close(refocus_max_blur_radius(&lens, &range, width), references[i].k, 1e-6);
        assert_close(refocus_f_number_of_blur(&lens, &range, width, references[i].k),
                     references[i].f_number, 1e-6);
        assert_true(fabs(refocus_disparity_of_depth(&range, references[i].zf) - references[i].df) <
                    1e-6);
        assert_close(refocus_depth_of_disparity(&range, references[i].df), references[i].zf, 1e-6);
    }
}

/* The circle on the sensor is that of eq. 2, but for the picture's growth 1 / (1 - f/zf)
 * when the lens moves out to focus. */
TEST(test_circle_of_confusion)
{
    static const double depths[] = {0.4, 0.5, 0.87, 1, 2, 17, 300, INFINITY};
    enum { N = sizeof depths / sizeof *depths };
    const struct refocus_lens lens = {50, 2, 36};
    const struct refocus_depth_range range = {0.4, INFINITY};
    const double width = 1000, k = refocus_max_blur_radius(&lens, &range, width);

    for (int i = 0; i < N; i++) {
        for (int j = 0; j < N; j++) {
            const double u = depths[i], p = depths[j], f = 0.05;
            const double c = refocus_circle_of_confusion_m(&lens, u, p);
            const double vu = isinf(u) ? f : f * u / (u - f);
            const double vp = isinf(p) ? f : f * p / (p - f);

            assert_true(fabs(c - fabs(vu - vp) * f / (2 * vp)) < 1e-15); /* eq. 8 */
            const double radius_px = c / 2 / 0.036 * width;
            const double r = refocus_blur_radius(k, refocus_disparity_of_depth(&range, p),
                                                 refocus_disparity_of_depth(&range, u));
            assert_true(fabs(radius_px * (1 - f / u) - r) < 1e-10);
            assert_true((c == 0) == (i == j));
        }
    }
    assert_true(isnan(refocus_circle_of_confusion_m(&lens, 0.05, 1)));
    assert_true(isnan(refocus_circle_of_confusion_m(&lens, 1, 0.05)));
}

TEST(test_round_trips)
{
    static const struct refocus_depth_range ranges[] = {
        {0.5, 8}, {0.5, INFINITY}, {1e-3, 1e6}, {3, 3.0001}};

    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++) {
        assert_true(refocus_disparity_of_depth(ranges + i, ranges[i].near_m) == 1);
        assert_true(refocus_disparity_of_depth(ranges + i, ranges[i].far_m) == 0);
        assert_close(refocus_depth_of_disparity(ranges + i, 1), ranges[i].near_m, 1e-9);
        for (int d = 1; d <= 20; d++) { /* 2: twice as near as z0 and more */
            const double z = refocus_depth_of_disparity(ranges + i, d / 10.0);
            assert_close(refocus_disparity_of_depth(ranges + i, z), d / 10.0, 1e-9);
        }
    }
    assert_true(isinf(refocus_depth_of_disparity(ranges + 1, 0)));
    assert_true(isnan(refocus_depth_of_disparity(ranges + 1, -0.1)));
    assert_close(refocus_depth_of_disparity(ranges + 0, -1.0 / 30), 16, 1e-9);

    const struct refocus_lens lens = {4.25, 1.8, 5.6};
    const double k = refocus_max_blur_radius(&lens, ranges, 4000);
    assert_close(refocus_f_number_of_blur(&lens, ranges, 4000, k), 1.8, 1e-14);
    assert_close(refocus_f_number_of_blur(&lens, ranges, 4000, 2 * k), 0.9, 1e-14);
}

TEST(test_bad_arguments)
{
    static const double bad[] = {0, -1, NAN, INFINITY, -INFINITY};
    const struct refocus_lens good = {50, 2, 36};
    const struct refocus_depth_range range = {1, 5};

    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        const struct refocus_lens lenses[] = {{bad[i], 2, 36}, {50, bad[i], 36}, {50, 2, bad[i]}};
        for (int j = 0; j < 3; j++) {
            assert_true(isnan(refocus_aperture_radius_m(lenses + j)));
            assert_true(isnan(refocus_focal_length_px(lenses + j, 100)));
            assert_true(isnan(refocus_max_blur_radius(lenses + j, &range, 100)));
            assert_true(isnan(refocus_f_number_of_blur(lenses + j, &range, 100, 5)));
            assert_true(isnan(refocus_circle_of_confusion_m(lenses + j, 1, 2)));
            assert_true(isnan(refocus_hyperfocal_m(lenses + j, 1000)));
        }
        assert_true(isnan(refocus_focal_length_px(&good, bad[i])));
        assert_true(isnan(refocus_max_blur_radius(&good, &range, bad[i])));
        assert_true(isnan(refocus_f_number_of_blur(&good, &range, 100, bad[i])));
        assert_true(isnan(refocus_hyperfocal_m(&good, bad[i])));
        assert_true(isnan(refocus_depth_of_field_m(1, bad[i]).near_m));
        assert_true(isnan(refocus_depth_of_field_m(1, bad[i]).far_m));

        const struct refocus_depth_range ranges[] = {
            {bad[i], 5}, {1, -bad[i]}, {5, 1}, {1, 1}, {1, NAN}};
        for (int j = 0; j < 5; j++) {
            if (ranges[j].near_m == 1 && ranges[j].far_m > 1)
                continue; /* this range is good */
            assert_true(isnan(refocus_disparity_of_depth(ranges + j, 2)));
            assert_true(isnan(refocus_depth_of_disparity(ranges + j, 0.5)));
            assert_true(isnan(refocus_max_blur_radius(&good, ranges + j, 100)));
        }
    }
    assert_true(isnan(refocus_disparity_of_depth(&range, 0)));
    assert_true(isnan(refocus_disparity_of_depth(&range, -1)));
    assert_true(isnan(refocus_disparity_of_depth(&range, NAN)));
    assert_true(isnan(refocus_depth_of_disparity(&range, NAN)));
    assert_true(isnan(refocus_depth_of_disparity(&range, INFINITY)));
    assert_true(isnan(refocus_blur_radius(-1, 0, 0)));
    assert_true(isnan(refocus_blur_radius(INFINITY, 0, 0)));
    assert_true(isnan(refocus_blur_radius(1, NAN, 0)));
    assert_true(isnan(refocus_blur_radius(1, 0, NAN)));
    assert_true(isnan(refocus_aperture_radius_m(NULL)));
    assert_true(isnan(refocus_f_number_of_blur(NULL, &range, 100, 5)));
    assert_true(isnan(refocus_max_blur_radius(&good, NULL, 100)));
}

/* Mulder & van Liere 2000, section 2: the circle on the retina, and as large on a screen as it has
 * to look. A pupil of E is the lens with f / N = E whose picture is seen at the same angle; the
 * distances of retina and screen do not matter. */
TEST(test_pupil)
{
    const double pupil = 0.008, retina = 0.017, angle = 50 * 3.14159265358979323846 / 180;
    const double screen_m[] = {0.4, 2}, depth_m[] = {0.33, 0.9, 1.47}, width = 512;

    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 3; j++) {
            const double focus = 0.83, d = depth_m[j];
            const double power = 1 / (1 / focus + 1 / retina); /* P */
            const double vd = power * d / (d - power), vf = power * focus / (focus - power);
            const double on_retina = fabs(vd - vf) * pupil / vd;
            const double on_screen = screen_m[i] / retina * on_retina;
            const double pixels = on_screen * width / (2 * screen_m[i] * tan(angle / 2));
            const double focal_length_mm = 18 / tan(angle / 2);
            const struct refocus_lens lens = {focal_length_mm, focal_length_mm / 1000 / pupil, 36};
            const struct refocus_depth_range range = {fmin(d, focus), fmax(d, focus)};

            assert_close(2 * refocus_max_blur_radius(&lens, &range, width), pixels, 1e-12);
        }
    }
}
