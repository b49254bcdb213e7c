/** @file refocus.hpp  The library for C++11 and later: handles that end themselves, and exceptions.
 *
 *     refocus::renderer renderer(width, height, 20);
 *
 *     renderer.prepare(photo, disparity);
 *     renderer.render(refocus_settings_default(0.8f, 20), out);
 *
 * Header only, on top of the functions in C, whose descriptions hold; pictures and maps are the
 * structs of C. Handles can be moved and not copied; get() has the C handle, which stays theirs.
 */
#ifndef REFOCUS_REFOCUS_HPP
#define REFOCUS_REFOCUS_HPP

#include <cstdio>
#include <stdexcept>
#include <utility>
#include <refocus/refocus.h>

namespace refocus
{

/** Any error of the library: what() has its words, status() is that of enum refocus_status. */
class error : public std::runtime_error
{
  public:
    explicit error(int status, const char *words = nullptr)
        : std::runtime_error(words && *words ? words : refocus_strerror(status)), status_(status)
    {
    }
    int status() const noexcept
    {
        return status_;
    }

  private:
    int status_;
};

/** Throws refocus::error of a negative status, such as refocus_upsample() returns.
 *  @return the status, which is 0 or a count */
inline int check(int status, const char *words = nullptr)
{
    if (status < 0)
        throw error(status, words);
    return status;
}

/** The owner of a C handle that DESTROY ends. */
template <class Handle, void (*Destroy)(Handle **)> class handle
{
  public:
    handle() noexcept = default;
    handle(handle &&other) noexcept : handle_(other.handle_)
    {
        other.handle_ = nullptr;
    }
    handle &operator=(handle &&other) noexcept
    {
        std::swap(handle_, other.handle_);
        return *this;
    }
    handle(const handle &) = delete;
    handle &operator=(const handle &) = delete;
    ~handle()
    {
        Destroy(&handle_);
    }

    Handle *get() const noexcept
    {
        return handle_;
    }

  protected:
    Handle *handle_ = nullptr;
};

/** The shape of the aperture; may be shared by threads. */
class aperture : public handle<refocus_aperture, refocus_aperture_destroy>
{
  public:
    explicit aperture(const refocus_aperture_params &params)
    {
        check(refocus_aperture_create(&handle_, &params));
    }
    /** A regular polygon, see refocus_aperture_create_polygon(). */
    explicit aperture(int blades, double rotation_deg = 0)
    {
        check(refocus_aperture_create_polygon(&handle_, blades, rotation_deg));
    }
};

/** A renderer: one thread at a time, but cancel() and info(). Errors have the words that
 *  struct refocus_log would get, unless the parameters have a log of their own. */
class renderer : public handle<refocus_renderer, refocus_renderer_destroy>
{
  public:
    explicit renderer(refocus_renderer_params params)
    {
        if (!params.log.message)
            params.log.message = keep_words;
        call(refocus_renderer_create, &handle_, &params);
    }
    renderer(int32_t max_width, int32_t max_height, float max_blur_radius)
        : renderer(refocus_renderer_params_default(max_width, max_height, max_blur_radius))
    {
    }

    void prepare(const refocus_image &photo, const refocus_disparity &disparity)
    {
        call(refocus_prepare, handle_, &photo, &disparity);
    }
    void prepare(const refocus_scene &scene)
    {
        call(refocus_prepare_scene, handle_, &scene);
    }

    void render(const refocus_settings &settings, const refocus_image &out)
    {
        call(refocus_render_settings, handle_, &settings, &out);
    }
    void render(const refocus_render_params &params, const refocus_image &out)
    {
        call(refocus_render, handle_, &params, &out);
    }

    /** Ends what another thread does with it early, which throws REFOCUS_ERR_CANCELLED there. */
    void cancel() noexcept
    {
        refocus_cancel(handle_);
    }

    void view(refocus_view layer, uint16_t *out, ptrdiff_t stride)
    {
        call(refocus_get_view, handle_, static_cast<uint32_t>(layer), out, stride);
    }
    refocus_depth_edges_report depth_edges() const
    {
        refocus_depth_edges_report report = refocus_depth_edges_report_default();

        check(refocus_get_depth_edges(handle_, &report));
        return report;
    }
    refocus_renderer_info info() const noexcept
    {
        refocus_renderer_info info = refocus_renderer_info_default();

        refocus_renderer_get_info(handle_, &info);
        return info;
    }

  private:
    /* The words come on the thread that calls, before the call returns. */
    static char *words() noexcept
    {
        static thread_local char text[256];
        return text;
    }
    static void keep_words(void *, const char *text)
    {
        std::snprintf(words(), 256, "%s", text);
    }

    template <class... Parameters, class... Arguments>
    static void call(int (*function)(Parameters...), Arguments &&...arguments)
    {
        words()[0] = 0;
        check(function(std::forward<Arguments>(arguments)...), words());
    }
};

/** A filter over the depth maps of a video; one thread at a time. */
class temporal : public handle<refocus_temporal, refocus_temporal_destroy>
{
  public:
    explicit temporal(const refocus_temporal_params &params)
    {
        check(refocus_temporal_create(&handle_, &params));
    }
    void reset() noexcept
    {
        refocus_temporal_reset(handle_);
    }
    void cancel() noexcept
    {
        refocus_temporal_cancel(handle_);
    }

    /** @param photo  nullptr = by depth alone */
    void run(const refocus_image *photo, const refocus_disparity &map, uint16_t *out,
             ptrdiff_t stride)
    {
        check(refocus_temporal_run(handle_, photo, &map, out, stride));
    }
};

} // namespace refocus
#endif
