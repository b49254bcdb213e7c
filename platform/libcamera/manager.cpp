/* manager.cpp: the camera manager is started once for the process, and cameras are found by name.
 */
#include "manager.hpp"

#include <condition_variable>
#include <mutex>

#include <libcamera/logging.h>

using namespace libcamera;

namespace refocus_libcamera
{

/* libcamera allows one manager in a process, and ends the program when it still runs at
 * the end of main(): the sources that are open share it, and the last one stops it. The
 * next one waits until it has. */
namespace
{

std::mutex lock;
std::condition_variable ended;
std::weak_ptr<CameraManager> shared;
bool exists = false;

void end(CameraManager *manager)
{
    std::lock_guard<std::mutex> guard(lock);

    manager->stop();
    delete manager;
    exists = false;
    ended.notify_all();
}

} // namespace

std::shared_ptr<CameraManager> get_manager()
{
    std::unique_lock<std::mutex> guard(lock);
    std::shared_ptr<CameraManager> manager;

    while (!(manager = shared.lock()) && exists)
        ended.wait(guard);
    if (manager)
        return manager;
    logSetTarget(LoggingTargetNone); /* failures are told in reasons */
    std::unique_ptr<CameraManager> made = std::make_unique<CameraManager>();
    if (made->start() != 0)
        return nullptr;
    exists = true;
    manager = std::shared_ptr<CameraManager>(made.release(), end);
    shared = manager;
    return manager;
}

std::shared_ptr<Camera> find_camera(CameraManager &manager, const std::string &name)
{
    std::shared_ptr<Camera> camera = manager.get(name);
    const auto cameras = manager.cameras();

    if (camera || name.empty() || name.find_first_not_of("0123456789") != std::string::npos ||
        name.size() > 4)
        return camera;
    const size_t n = (size_t)std::stoul(name);
    return n < cameras.size() ? cameras[n] : nullptr;
}

} // namespace refocus_libcamera
