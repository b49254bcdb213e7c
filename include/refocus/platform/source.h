/** @file platform/source.h  Frames from cameras, files and scripts.
 *
 * Part of librefocus-capture, not of the core: pkg-config name `refocus-capture`. A
 * source is opened by name:
 *
 *     v4l2:/dev/video0            a V4L2 capture node
 *     libcamera:0                 a libcamera camera, by its number or its identifier
 *     pipewire:[NODE]             a node of PipeWire that gives video, by its name, number or
 *         description; of no name the best camera
 *     file:frames-%04d.png        pictures; one conversion that takes an int, from the
 *         lowest number that is there on; a number that is missing before others, up to 100 farther
 * on, is an error. They have no rate: it is that of the config, else 30 file:photo.jpg one picture,
 * as often as it is asked for y4m:FILE                    a YUV4MPEG2 stream of whole frames, not
 * of fields; "-" is standard input. Of a pipe the header is read when it is started, or asked for
 * its mode raw:FILE,NV12,640x480,30    frames without a header: format, size, rate; without it, as
 * of file: replay:SCRIPT               frames and faults by a script; see platform/README.md
 *     replay::LINE;LINE;...       the same with the script in the name
 *
 * The life of a source: open, start, then wait and release for each frame, stop, close.
 * When wait reports that the device has failed or gone, refocus_source_restart() opens
 * it again.
 *
 * One thread at a time may call into a source, except refocus_source_interrupt(), which any thread
 * may call while the source is open.
 */
#ifndef REFOCUS_PLATFORM_SOURCE_H
#define REFOCUS_PLATFORM_SOURCE_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <refocus/image.h>
#include <refocus/platform/file.h>
#include <refocus/sized.h>
#include <refocus/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Pixel formats of frames, named by the order of their bytes. */
enum refocus_frame_format {
    REFOCUS_FRAME_ANY = 0,
    REFOCUS_FRAME_YUYV = 1,   /**< 4:2:2, Y U Y V */
    REFOCUS_FRAME_UYVY = 2,   /**< 4:2:2, U Y V Y */
    REFOCUS_FRAME_NV12 = 3,   /**< 4:2:0, a plane of Y and one of U V */
    REFOCUS_FRAME_NV21 = 4,   /**< 4:2:0, a plane of Y and one of V U */
    REFOCUS_FRAME_YUV420 = 5, /**< 4:2:0, planes of Y, U and V */
    REFOCUS_FRAME_RGB24 = 6,  /**< R G B */
    REFOCUS_FRAME_BGR24 = 7,  /**< B G R */
    REFOCUS_FRAME_RGBX = 8,   /**< R G B and a byte without meaning */
    REFOCUS_FRAME_BGRX = 9,   /**< B G R and a byte without meaning */
    REFOCUS_FRAME_MJPEG = 10, /**< one JPEG picture in plane 0 */
    REFOCUS_FRAME_GREY = 11,  /**< 8 bits */
    REFOCUS_FRAME_Y16 = 12,   /**< 16 bits, little endian */
    REFOCUS_FRAME_Z16 = 13,   /**< 16 bits, little endian, a distance; 0 = unknown */
};
enum { REFOCUS_FRAME_FORMAT_COUNT = 14 };

/** "YUYV", "NV12", ... ; NULL for an unknown one. Thread-safe. */
REFOCUS_API const char *refocus_frame_format_name(uint32_t format);

enum refocus_frame_flags {
    REFOCUS_FRAME_CORRUPT = 1,    /**< the driver says that pixels are missing or wrong */
    REFOCUS_FRAME_FULL_RANGE = 2, /**< Y, U and V use 0 to 255, not 16 to 235 (240) */
    REFOCUS_FRAME_CHANGED = 4,    /**< format, size or stride differ from the frame before */
    REFOCUS_FRAME_MONOTONIC = 8,  /**< timestamp_ns is of CLOCK_MONOTONIC */
    REFOCUS_FRAME_STILL = 16,     /**< one picture at every time: it goes with any other */
};

/** A frame in the memory of the source, until it is released. Programs that make frames of their
 * own, for refocus_convert_rgb8() and the like, start from refocus_frame_default() or
 * refocus_frame_copy(). */
struct refocus_frame {
    uint32_t struct_size;    /**< sizeof(struct refocus_frame) where it was made */
    uint32_t format;         /**< enum refocus_frame_format */
    int32_t width, height;   /**< pixels */
    const uint8_t *plane[3]; /**< may be uncached camera memory: read it once, in order */
    ptrdiff_t stride[3];     /**< bytes from a row to the next one below */
    uint64_t bytes;          /**< bytes of an MJPEG picture */
    uint32_t matrix;         /**< enum refocus_matrix; of y4m and raw, which have no word for it,
                                  BT.709 from a width of 1280 or more than 576 rows on */
    uint32_t flags;          /**< enum refocus_frame_flags, or-ed */
    int64_t timestamp_ns;    /**< when it was taken */
    uint32_t sequence;       /**< number by the camera; gaps are frames it dropped; wraps */
    uint32_t buffer;         /**< number of the buffer it lies in */
    float lens_dioptres;     /**< 1 / focus distance in metres; NAN when not known */
    int dmabuf[3];           /**< descriptor of each plane's memory, of the source; or -1 */
};

/** A frame of no size and format, whose lens and descriptors are not known. Thread-safe. */
static inline struct refocus_frame refocus_frame_default(void)
{
    struct refocus_frame frame;
    int i;

    memset(&frame, 0, sizeof frame);
    frame.struct_size = sizeof frame;
    frame.lens_dioptres = NAN;
    for (i = 0; i < 3; i++)
        frame.dmabuf[i] = -1;
    return frame;
}

/**
 * A copy of a frame, for programs that change it. Its planes are the frame's, and end with it.
 * `copy = *frame` would not do: an older library has fewer bytes there than the program knows of,
 * and a newer one says a size that the copy does not have.
 *
 * @param frame  of a source; NULL, or a struct_size out of its range, gives
 *               refocus_frame_default()
 *
 * Thread-safe.
 */
static inline struct refocus_frame refocus_frame_copy(const struct refocus_frame *frame)
{
    const size_t smallest = REFOCUS_SIZE_TO(struct refocus_frame, dmabuf);
    struct refocus_frame copy = refocus_frame_default();

    if (frame && frame->struct_size >= smallest && frame->struct_size <= REFOCUS_MAX_STRUCT_SIZE) {
        memcpy(&copy, frame, frame->struct_size < sizeof copy ? frame->struct_size : sizeof copy);
        copy.struct_size = sizeof copy;
    }
    return copy;
}

/** Where samples of U and V of 4:2:0 lie. The library does not look at it; streams carry it on. */
enum refocus_chroma_place {
    REFOCUS_CHROMA_PLACE_NONE = 0,   /**< not known */
    REFOCUS_CHROMA_PLACE_CENTRE = 1, /**< amid four pixels, as in JPEG and MPEG-1 */
    REFOCUS_CHROMA_PLACE_LEFT = 2,   /**< between two pixels of a column, as in MPEG-2 */
    REFOCUS_CHROMA_PLACE_DV = 3,     /**< on a pixel, U and V in turns, as in PAL DV */
    REFOCUS_CHROMA_PLACE_COUNT
};

/** A kind of frames that a source can deliver. Start from refocus_source_mode_default(). */
struct refocus_source_mode {
    uint32_t struct_size;    /**< sizeof(struct refocus_source_mode), set by the caller */
    uint32_t format;         /**< enum refocus_frame_format */
    int32_t width, height;   /**< pixels */
    double fps;              /**< frames a second at most; 0 = not known */
    int32_t pixel_aspect[2]; /**< width to height of a pixel, of y4m; 0 and 0 = not known */
    uint32_t chroma_place;   /**< enum refocus_chroma_place, of y4m */
    uint32_t reserved;       /**< 0 */
};

static inline struct refocus_source_mode refocus_source_mode_default(void)
{
    struct refocus_source_mode mode;

    memset(&mode, 0, sizeof mode);
    mode.struct_size = sizeof mode;
    return mode;
}

enum refocus_source_flags {
    REFOCUS_SOURCE_FAST = 1,   /**< files and scripts: as fast as can be, none is dropped */
    REFOCUS_SOURCE_LOOP = 2,   /**< files: from the beginning again at the end; no pipes */
    REFOCUS_SOURCE_DEPTH = 4,  /**< files: the samples of depth files, not their pictures */
    REFOCUS_SOURCE_DMABUF = 8, /**< V4L2: export the buffers as DMA-BUF */
};

/** Wishes for a source. Zeros: whatever the source prefers. */
struct refocus_source_config {
    uint32_t struct_size;  /**< sizeof(struct refocus_source_config) */
    uint32_t format;       /**< enum refocus_frame_format */
    int32_t width, height; /**< pixels; the nearest that there is will be taken */
    double fps;            /**< frames a second */
    int32_t buffers;       /**< 2 to 32; 0 = 4 */
    uint32_t flags;        /**< enum refocus_source_flags, or-ed */
    double default_fps;    /**< frames a second where neither fps nor the source says how many,
                                as pictures (file:) do not; 0 = 30 */
};

static inline struct refocus_source_config refocus_source_config_default(void)
{
    struct refocus_source_config config;

    memset(&config, 0, sizeof config);
    config.struct_size = sizeof config;
    return config;
}

/** Counts since the source was opened; restarts do not reset them. Start from
 * refocus_source_counters_default(). */
struct refocus_source_counters {
    uint32_t struct_size; /**< sizeof(struct refocus_source_counters), set by the caller */
    uint32_t reserved;    /**< 0 */
    uint64_t frames;      /**< handed out by wait */
    uint64_t released;    /**< taken back; equal to frames when none is out */
    uint64_t dropped;     /**< gaps in the sequence of the camera */
    uint64_t corrupt;     /**< handed out with REFOCUS_FRAME_CORRUPT */
    uint64_t dequeued;    /**< buffers taken from the driver */
    uint64_t queued;      /**< buffers given back to the driver after that */
    uint64_t lost;        /**< buffers that the driver did not take back, or dropped with a stop */
    uint64_t restarts;    /**< refocus_source_restart() that succeeded */
};

static inline struct refocus_source_counters refocus_source_counters_default(void)
{
    struct refocus_source_counters counters;

    memset(&counters, 0, sizeof counters);
    counters.struct_size = sizeof counters;
    return counters;
}

/** The kind of source that a name stands for. */
enum refocus_source_kind {
    REFOCUS_SOURCE_KIND_NONE = 0,   /**< no source */
    REFOCUS_SOURCE_KIND_FILE = 1,   /**< file, y4m, raw: read as fast as is wanted */
    REFOCUS_SOURCE_KIND_CAMERA = 2, /**< v4l2, libcamera, pipewire: it has a clock of its own */
    REFOCUS_SOURCE_KIND_SCRIPT = 3, /**< replay: behaves as a camera does */
};

/** enum refocus_source_kind by the word before the colon, whether this build has that kind and
 *  whether there is such a source or not. Thread-safe. */
REFOCUS_API uint32_t refocus_source_kind(const char *name);

/** A source. Opaque. */
struct refocus_source;

/**
 * Open a source by name; see the top of this file.
 *
 * @param source  receives the source, or NULL on an error; ended by
 *                refocus_source_close()
 * @param reason  receives words on an error; may be NULL, as in all functions here
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT (the name), REFOCUS_ERR_UNSUPPORTED (left
 *         out of this build, or no capture device), REFOCUS_ERR_GONE (no such device),
 *         REFOCUS_ERR_BUSY, REFOCUS_ERR_PERMISSION, REFOCUS_ERR_IO, REFOCUS_ERR_FORMAT,
 *         REFOCUS_ERR_MEMORY
 */
REFOCUS_API int refocus_source_open(struct refocus_source **source, const char *name,
                                    struct refocus_reason *reason);

/** Stop and close; sets the handle to NULL. A NULL handle is fine. */
REFOCUS_API void refocus_source_close(struct refocus_source **source);

/**
 * Mode number @p index.
 *
 * @param mode  receives it; only its struct_size is read
 * @return REFOCUS_OK, or REFOCUS_ERR_ARGUMENT: there are not as many, or the struct_size of
 *         @p mode is out of its range, which leaves it untouched; for a pipe as
 *         refocus_source_start()
 */
REFOCUS_API int refocus_source_get_mode(struct refocus_source *source, int index,
                                        struct refocus_source_mode *mode);

/**
 * Begin to stream.
 *
 * @param config  NULL: whatever the source prefers
 * @param mode    receives what will come; only its struct_size is read; may be NULL
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_STATE (it streams),
 *         REFOCUS_ERR_UNSUPPORTED (not in this format), REFOCUS_ERR_CANCELLED (interrupted
 *         while it waited for the header of a pipe), and as refocus_source_open().
 *         After an error the source is stopped.
 */
REFOCUS_API int refocus_source_start(struct refocus_source *source,
                                     const struct refocus_source_config *config,
                                     struct refocus_source_mode *mode,
                                     struct refocus_reason *reason);

/**
 * Wait for the next frame.
 *
 * @param timeout_ms  0, or negative: only look
 * @param frame       receives the frame; it and its memory stay until it is released. A map that
 *                    is damaged or missing in a sequence of them (REFOCUS_SOURCE_DEPTH) is a
 *                    frame without planes, REFOCUS_FRAME_CORRUPT, of which @p reason says why
 * @return REFOCUS_OK, REFOCUS_ERR_TIMEOUT, REFOCUS_ERR_CANCELLED (interrupted),
 *         REFOCUS_ERR_END (no more frames), REFOCUS_ERR_GONE (unplugged) or
 *         REFOCUS_ERR_IO (the stream failed): release all frames and restart,
 *         REFOCUS_ERR_FORMAT (a damaged file), REFOCUS_ERR_MEMORY,
 *         REFOCUS_ERR_STATE (not streaming, or every buffer is out)
 */
REFOCUS_API int refocus_source_wait(struct refocus_source *source, int timeout_ms,
                                    const struct refocus_frame **frame,
                                    struct refocus_reason *reason);

/** Give a frame back. NULL is fine. */
REFOCUS_API void refocus_source_release(struct refocus_source *source,
                                        const struct refocus_frame *frame);

/** End the stream; frames that are out become invalid. Fine when it does not stream. */
REFOCUS_API void refocus_source_stop(struct refocus_source *source);

/**
 * Stop, close the device, open it again by its name, start again as before. Frames that
 * are out become invalid. To be called again every 100 ms or so until it succeeds.
 *
 * @return as refocus_source_start(), and REFOCUS_ERR_CANCELLED after an interrupt
 */
REFOCUS_API int refocus_source_restart(struct refocus_source *source,
                                       struct refocus_source_mode *mode,
                                       struct refocus_reason *reason);

/**
 * Let the wait that is running, and later ones, return REFOCUS_ERR_CANCELLED, until the
 * next refocus_source_start(). Thread-safe.
 */
REFOCUS_API void refocus_source_interrupt(struct refocus_source *source);

/**
 * Set a control by name: for V4L2 the driver's names in lower case with underscores
 * ("brightness", "focus_absolute"), for libcamera its own ("LensPosition").
 *
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT (no such control; NAN, or no value of 32
 *         bits), REFOCUS_ERR_UNSUPPORTED (the source has none), REFOCUS_ERR_GONE,
 *         REFOCUS_ERR_IO
 */
REFOCUS_API int refocus_source_set_control(struct refocus_source *source, const char *name,
                                           double value, struct refocus_reason *reason);

/** How a lens comes to its focus. */
enum refocus_source_focus {
    REFOCUS_SOURCE_FOCUS_CONTINUOUS = 0, /**< by the camera, all the time */
    REFOCUS_SOURCE_FOCUS_ONCE = 1,       /**< by the camera, once; then it stays */
    REFOCUS_SOURCE_FOCUS_FIXED = 2,      /**< at a position */
    REFOCUS_SOURCE_FOCUS_OFF = 3,        /**< not at all: it stays where it is */
    REFOCUS_SOURCE_FOCUS_COUNT
};

/** The abilities and the place of a lens. Start from refocus_source_lens_default(). */
struct refocus_source_lens {
    uint32_t struct_size; /**< sizeof(struct refocus_source_lens), set by the caller */
    uint32_t modes;    /**< bit n: refocus_source_set_focus() takes enum refocus_source_focus n */
    uint32_t dioptres; /**< 1: positions are dioptres, 1 / metres; 0: they have no unit. In
                            either case a larger one is nearer. */
    uint32_t reserved; /**< 0 */
    double least, greatest; /**< positions that it can be sent to; 0 and 0 without FIXED */
    double position;        /**< where it is: as the frame that was last taken says (libcamera,
                                 replay), or as the driver says now (V4L2); NAN = not known */
};

static inline struct refocus_source_lens refocus_source_lens_default(void)
{
    struct refocus_source_lens lens;

    memset(&lens, 0, sizeof lens);
    lens.struct_size = sizeof lens;
    lens.position = NAN;
    return lens;
}

/**
 * Ask what the lens can do. Cameras whose lens does not move, and files, have no modes.
 *
 * @param lens  receives it; only its struct_size is read
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_GONE
 */
REFOCUS_API int refocus_source_get_lens(struct refocus_source *source,
                                        struct refocus_source_lens *lens,
                                        struct refocus_reason *reason);

/**
 * Focus. It takes effect some frames later; refocus_source_get_lens() says where the lens is.
 * It may come before the source is started, and is said again to a device that is opened again.
 * Without it libcamera focuses all the time, and V4L2 as the device does.
 *
 * @param mode      enum refocus_source_focus
 * @param position  for FIXED, within the range of the lens; else it is not read
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT (the mode or the position), REFOCUS_ERR_UNSUPPORTED
 *         (the lens has no such mode), REFOCUS_ERR_GONE, REFOCUS_ERR_IO
 */
REFOCUS_API int refocus_source_set_focus(struct refocus_source *source, uint32_t mode,
                                         double position, struct refocus_reason *reason);

/**
 * Keep exposure, gain and white balance as they are now, or leave them to the camera again.
 * What a camera cannot keep is passed over.
 *
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_UNSUPPORTED (it keeps none of them),
 *         REFOCUS_ERR_GONE, REFOCUS_ERR_IO
 */
REFOCUS_API int refocus_source_lock_exposure(struct refocus_source *source, int lock,
                                             struct refocus_reason *reason);

/** Get the counts so far, all 0 for a NULL source. With NULL @p counters, or with ones whose
 *  struct_size is out of its range, it does nothing. */
REFOCUS_API void refocus_source_get_counters(const struct refocus_source *source,
                                             struct refocus_source_counters *counters);

/** Receives a camera: the name to open it by, and what it calls itself. */
typedef void refocus_source_found(void *user, const char *name, const char *description);

/** List the cameras of this machine. @return their number or a negative status:
 *  REFOCUS_ERR_ARGUMENT when @p found is NULL */
REFOCUS_API int refocus_source_list(refocus_source_found *found, void *user);

/** The kinds of sources that this build has, e.g. "v4l2 libcamera pipewire file y4m raw replay".
 * Thread-safe. */
REFOCUS_API const char *refocus_source_backends(void);

#ifdef __cplusplus
}
#endif
#endif
