/* module.cpp: the module of OpenCV's contrib filters is loaded when it is asked for. */
#include "module.hpp"

#include <dlfcn.h>
#include <string>

namespace
{

const rf_ximgproc *open(const std::string &path)
{
    void *const module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    const auto filters =
        module ? static_cast<const rf_ximgproc *>(dlsym(module, "rf_ximgproc_filters")) : nullptr;

    return filters && filters->version == RF_XIMGPROC_VERSION ? filters : nullptr;
}

/* The module lies beside this library, where both are installed and where both are built. */
const rf_ximgproc *find()
{
    static const char here = 0;
    const rf_ximgproc *filters = nullptr;
    Dl_info self;

    try {
        if (dladdr(&here, &self) && self.dli_fname) {
            const std::string path(self.dli_fname);
            const std::string folder = path.substr(0, path.rfind('/') + 1);

            filters = open(folder + "refocus/refocus-ximgproc.so");
            if (!filters)
                filters = open(folder + "../ximgproc/refocus-ximgproc.so");
        }
        if (!filters)
            filters = open(RF_MODULE_FOLDER "/refocus-ximgproc.so");
    } catch (...) {
    }
    return filters;
}

} // namespace

const rf_ximgproc *rf_opencv_ximgproc()
{
    static const rf_ximgproc *const filters = find();

    return filters;
}
