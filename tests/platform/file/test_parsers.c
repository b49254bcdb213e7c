/* test_parsers.c: the library's own small parsers, on what files hold and on what they should
 * not. */
#include "check.h"
#include "base64.h"
#include "depth_values.h"
#include "exif.h"
#include "formats.h"
#include "heif_boxes.h"
#include "heif_turn.h"
#include "letters.h"
#include "md5.h"
#include "mpf.h"
#include "number.h"
#include "png_format.h"
#include "reason.h"

#include <math.h>

TEST(numbers)
{
    static const struct {
        const char *text;
        double value;
    } good[] = {
        {"0", 0},
        {"-0.5", -0.5},
        {" +12 ", 12},
        {"1e3", 1000},
        {"2.5E-3", 0.0025},
        {".5", 0.5},
        {"5.", 5},
        {"18.849538803100586", 18.849538803100586},
        {"123456789012345678901234567890", 123456789012345678901234567890.0},
        {"0.000000000000000000000000000001", 1e-30},
        {"0e99999", 0},
    };
    static const char *const bad[] = {"",    " ",   ".",   "-",     "e5",  "1,5",  "0x10",
                                      "nan", "inf", "1 2", "1e999", "--1", "1.2.3"};
    double value;

    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        assert_true(rf_parse_number(good[i].text, &value));
        assert_true(fabs(value - good[i].value) <= 1e-15 * fabs(good[i].value));
    }
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_false(rf_parse_number(bad[i], &value));
}

/* Letters in either case are the same, signs that are as far apart as they are not. */
TEST(words)
{
    assert_true(rf_same_word("", ""));
    assert_true(rf_same_word(".TIF", ".tif"));
    assert_true(rf_same_word("AZaz09", "azAZ09"));
    assert_false(rf_same_word(".tif", ".tiff"));
    assert_false(rf_same_word(".tiff", ".tif"));
    assert_false(rf_same_word("@[", "`{"));
    assert_false(rf_same_word("\xc9", "\xe9"));
    assert_true(rf_begins_with("DISParity", "disp"));
    assert_true(rf_begins_with("disp", "disp"));
    assert_false(rf_begins_with("dis", "disp"));
    assert_false(rf_begins_with("my_disp", "disp"));
}

TEST(base64_text)
{
    static const char *const bad[] = {"A", "AAAAA", "A*AA", "AA=A", "====A", "AA-_"};
    uint8_t bytes[256];
    char text[400];

    for (int i = 0; i < 256; i++)
        bytes[i] = (uint8_t)(i * 89);
    for (size_t size = 0; size <= 256; size++) {
        struct bytes coded = base64(bytes, size);
        assert_int_equal(rf_base64_decode((char *)coded.data, coded.size), size);
        if (size > 0)
            assert_memory_equal(coded.data, bytes, size);
        bytes_free(&coded);
    }
    strcpy(text, " QU\r\nJD\tRA ");
    assert_int_equal(rf_base64_decode(text, strlen(text)), 4);
    assert_memory_equal(text, "ABCD", 4);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        strcpy(text, bad[i]);
        assert_true(rf_base64_decode(text, strlen(text)) == (size_t)-1);
    }
}

/* Directories that point at themselves, at each other and outside. */
TEST(exif_offsets)
{
    static const uint32_t places[] = {0,   1,   7,   8,          62,         100,
                                      171, 176, 177, 0x7fffffff, 0xfffffffe, 0xffffffff};
    struct rf_exif exif;

    for (int big_endian = 0; big_endian < 2; big_endian++) {
        for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
            /* Offsets where the first directory and the settings' directory are said to be. */
            static const size_t fields[] = {4, 8 + 2 + 36 + 8};
            for (int field = 0; field < 2; field++) {
                struct bytes block = make_exif(big_endian, 6);
                struct bytes offset = {NULL, 0};
                uint8_t *const exact = malloc(block.size);

                bytes_number(&offset, places[i], 4, big_endian);
                memcpy(block.data + fields[field], offset.data, 4);
                memcpy(exact, block.data, block.size);
                rf_exif_parse(exact, block.size, &exif);
                assert_in_range(exif.orientation, 1, 8);
                free(exact);
                bytes_free(&offset);
                bytes_free(&block);
            }
        }
    }
}

TEST(exif_texts_are_clean)
{
    struct bytes block = make_exif(true, 1);
    struct rf_exif exif;

    block.data[128 + 1] = '\n';
    assert_true(rf_exif_parse(block.data, block.size, &exif));
    assert_string_equal(exif.camera, "M?ker Model X");
    bytes_free(&block);
    block = make_exif(true, 1);
    memcpy(block.data + 128 + 6, "Maker 2", 7);
    assert_true(rf_exif_parse(block.data, block.size, &exif));
    assert_string_equal(exif.camera, "Maker 2");
    bytes_free(&block);
}

TEST(mpf_bounds)
{
    struct bytes tiff = {NULL, 0};
    struct rf_mpf mpf;

    bytes_add(&tiff, "MM\0*\0\0\0\10\0\1\260\2\0\7\0\0\0\40\0\0\0\32\0\0\0\0", 26);
    bytes_add(&tiff, "\0\3\0\0\0\0\1\0\0\0\0\0\0\0\0\0", 16);
    bytes_add(&tiff, "\0\0\0\0\0\0\0\5\0\0\1\2\0\0\0\0", 16);
    assert_true(rf_mpf_parse((struct rf_bytes){tiff.data, tiff.size}, &mpf));
    assert_int_equal(mpf.count, 2);
    assert_int_equal(mpf.image[0].size, 256);
    assert_int_equal(mpf.image[1].size, 5);
    assert_int_equal(mpf.image[1].offset, 258);
    for (size_t size = 0; size < tiff.size; size++)
        assert_false(rf_mpf_parse((struct rf_bytes){tiff.data, size}, &mpf));
    bytes_free(&tiff);
}

/* Depth that reaches beyond infinity: d = 0 is at infinity. */
TEST(disparity_ranges)
{
    struct refocus_depth_map map = refocus_depth_map_default();

    rf_depth_from_disparity(&map, 0, 255, 0.5, 2);
    assert_true(map.near_m == 0.5 && map.far_m == 2 && map.value_far == 0);
    rf_depth_from_disparity(&map, 0, 255, 0, 2);
    assert_true(isinf(map.far_m) && map.value_far == 0);
    rf_depth_from_disparity(&map, 0, 100, -1, 3);
    assert_true(isinf(map.far_m) && map.value_far == 25 && map.value_near == 100);
}

/* Tracks without a picture are refused in words of their own; a file with both is a picture. */
TEST(heif_sequences)
{
    static const char head[] = "\0\0\0\24ftypmsf1\0\0\0\0hevc";
    static const char track[] = "\0\0\0\14moov\1\2\3\4", meta[] = "\0\0\0\14meta\0\0\0\0";
    struct bytes film = bytes_copy(head, 20), both;

    assert_false(rf_heif_is_sequence((struct rf_bytes){film.data, film.size}));
    bytes_add(&film, track, 12);
    assert_true(rf_heif_is_sequence((struct rf_bytes){film.data, film.size}));
    for (size_t size = 20; size < 32; size++)
        assert_false(rf_heif_is_sequence((struct rf_bytes){film.data, size}));
    both = bytes_copy(film.data, film.size);
    bytes_add(&both, meta, 12);
    assert_false(rf_heif_is_sequence((struct rf_bytes){both.data, both.size}));
    bytes_free(&both);
    read_photo(film, REFOCUS_ERR_UNSUPPORTED);
}

/* Two pictures are a stereo pair if a group of theirs says so, and two of a burst are none. */
TEST(heif_stereo)
{
    static const char names[][5] = {"ster", "altr", "brst"};

    for (int i = 0; i < 3; i++) {
        struct bytes file = bytes_copy("\0\0\0\24ftypheic\0\0\0\0mif1", 20);
        uint32_t pair[2];

        bytes_add(&file, "\0\0\0\60meta\0\0\0\0\0\0\0\44grpl\0\0\0\34", 24);
        bytes_add(&file, names[i], 4);
        bytes_add(&file, "\0\0\0\0\0\0\0\3\0\0\0\2\0\0\0\7\0\0\0\4", 20);
        assert_true(rf_heif_stereo_pair((struct rf_bytes){file.data, file.size}, pair) == (i == 0));
        assert_true(i > 0 || (pair[0] == 7 && pair[1] == 4));
        for (size_t size = 0; size < file.size; size++)
            assert_false(rf_heif_stereo_pair((struct rf_bytes){file.data, size}, pair));
        bytes_free(&file);
    }
}

TEST(heif_orientations)
{
    static const struct {
        struct heif_property properties[2];
        int count, orientation;
    } cases[] = {
        {{{"irot", 0}}, 1, 1},
        {{{"irot", 1}}, 1, 8}, /* 90 degrees anticlockwise */
        {{{"irot", 2}}, 1, 3},
        {{{"irot", 3}}, 1, 6},
        {{{"imir", 1}}, 1, 2}, /* left and right exchanged */
        {{{"imir", 0}}, 1, 4},
        {{{"irot", 1}, {"imir", 1}}, 2, 7},
        {{{"irot", 3}, {"imir", 1}}, 2, 5},
        {{{"imir", 1}, {"irot", 3}}, 2, 7},
        {{{"xxxx", 1}}, 1, 1},
    };

    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        for (int large = 0; large < 2; large++) {
            struct bytes file = make_heif_boxes(cases[i].properties, cases[i].count, large);

            assert_int_equal(rf_heif_orientation((struct rf_bytes){file.data, file.size}, 0),
                             cases[i].orientation);
            assert_int_equal(rf_heif_orientation((struct rf_bytes){file.data, file.size}, 2), 1);
            for (size_t size = 0; size < file.size; size++) {
                uint8_t *const exact = malloc(size ? size : 1);
                memcpy(exact, file.data, size);
                assert_int_equal(rf_heif_orientation((struct rf_bytes){exact, size}, 1), 1);
                free(exact);
            }
            bytes_free(&file);
        }
    }
}

/* A main picture whose number is cut off, at the end of the boxes: what lies behind it is no
 * number. Without the cut the same bytes turn the picture. */
TEST(heif_short_primary)
{
    const struct heif_property turned = {"irot", 1};
    struct bytes boxes = make_heif_boxes(&turned, 1, false);
    const size_t meta = 20, pitm = meta + 12, iprp = pitm + 14, all = boxes.size - iprp;
    uint8_t *const file = calloc(1, boxes.size);

    assert_memory_equal(boxes.data + iprp + 4, "iprp", 4);
    memcpy(file, boxes.data, pitm);
    memcpy(file + pitm, boxes.data + iprp, all);
    memcpy(file + pitm + all, boxes.data + pitm, 14);
    assert_int_equal(rf_heif_orientation((struct rf_bytes){file, boxes.size}, 0), 8);
    for (uint8_t size = 8; size < 14; size++) {
        file[pitm + all + 3] = size;
        assert_int_equal(rf_heif_orientation((struct rf_bytes){file, boxes.size}, 0), 1);
    }
    free(file);
    bytes_free(&boxes);
}

/* RFC 1321, A.5, and lengths around a block of 64 bytes. */
TEST(md5_of_the_rfc)
{
    static const struct {
        const char *text, *hex;
    } known[] = {
        {"", "D41D8CD98F00B204E9800998ECF8427E"},
        {"a", "0CC175B9C0F1B6A831C399E269772661"},
        {"message digest", "F96B697D7CB7938D525A2F31AAF161D0"},
        {"abcdefghijklmnopqrstuvwxyz", "C3FCD3D76192E4007DFB496CCA67E13B"},
        {"12345678901234567890123456789012345678901234567890123456789012345678901234567890",
         "57EDF4A22BE3C955AC49DA2E2107B67A"},
    };
    static const char *const of_length[] = {
        "04364420E25C512FD958A70738AA8F72", "668A72D5BA17F08E62DABCAFAD6DB14B",
        "693037871C4A9D3D8685018905CB530A", "7DC2CA208106A2F703567BDFF99D8981",
        "C1BB4F81D892B2D57947682AEB252456", "1BC932052302D074BDEC39795FE00CF6",
    };
    static const size_t lengths[] = {55, 56, 57, 63, 64, 65};
    uint8_t same[65];
    char hex[33];

    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        const struct rf_bytes text = {(const uint8_t *)known[i].text, strlen(known[i].text)};

        rf_md5_hex(text, hex);
        assert_string_equal(hex, known[i].hex);
    }
    memset(same, 'x', sizeof same);
    for (size_t i = 0; i < sizeof of_length / sizeof *of_length; i++) {
        rf_md5_hex((struct rf_bytes){same, lengths[i]}, hex);
        assert_string_equal(hex, of_length[i]);
    }
}

/* Four letters are a brand, whatever follows; there are files of other things with a brand, too. */
TEST(heif_brands)
{
    static const struct {
        const char *begin;
        bool known;
    } files[] = {{"\0\0\0\20ftypheicx", true},  {"\0\0\0\20ftypavisx", true},
                 {"\0\0\0\20ftypmif1x", true},  {"\0\0\0\20ftypmp42x", false},
                 {"\0\0\0\20ftypheiXx", false}, {"\0\0\0\20freeheicx", false}};

    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        const uint8_t *const begin = (const uint8_t *)files[i].begin;

        for (size_t size = 11; size <= 13; size++) {
            const struct rf_format *format = rf_format_of_content((struct rf_bytes){begin, size});

            assert_int_equal(format != NULL, files[i].known && size >= 12);
            assert_true(!format || strcmp(format->name, "HEIC") == 0);
        }
    }
}

/* Parts that are left out are told behind what was told before, as far as there is room. */
TEST(reasons_end)
{
    struct {
        struct refocus_reason reason;
        char behind[8];
    } told;
    const size_t room = sizeof told.reason.text;

    for (size_t used = 0; used < room; used++) {
        memset(&told, 'a', sizeof told);
        told.reason.text[used] = '\0';
        rf_leave_out(&told.reason, "%s", "bc");
        assert_memory_equal(told.behind, "aaaaaaaa", 8);
        assert_int_equal(strspn(told.reason.text, "a"), used);
        if (used + 4 < room)
            assert_string_equal(told.reason.text + used, used ? "; bc" : "bc");
        else
            assert_true(strlen(told.reason.text) < room);
    }
}

TEST(png_signature)
{
    static const uint8_t begin[] = "\x89PNG\r\n\x1a\n\xff";

    assert_false(rf_is_png((struct rf_bytes){begin, 7}));
    assert_true(rf_is_png((struct rf_bytes){begin, 8}));
    assert_true(rf_is_png((struct rf_bytes){begin, 9}));
}
