#include "io/features/reach.h"

#include <cpl_conv.h>
#include <cpl_http.h>
#include <cpl_string.h>
#include <cpl_vsi_virtual.h>
#include <fmt/format.h>
#include <ogr_srs_api.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <mutex>
#include <string_view>

namespace vfplan {

struct Reach::State {
    bool network = false;
    bool asked_a_service = false;
    std::string refused;
};

namespace {

// Of the youngest Reach of a thread. Without one the network is closed, and nobody asks.
thread_local Reach::State closed;
thread_local Reach::State* now = &closed;

bool refused(std::string_view name) {
    if (now->network) return false;
    if (now->refused.empty()) now->refused = name;
    return true;
}

// GDAL takes null for "not mine" and fetches by itself.
CPLHTTPResult* fetch(const char* url, CSLConstList, GDALProgressFunc, void*, CPLHTTPFetchWriteFunc,
                     void*, void*) {
    now->asked_a_service = true;
    if (!refused(url)) return nullptr;
    auto* nothing = static_cast<CPLHTTPResult*>(CPLCalloc(1, sizeof(CPLHTTPResult)));
    nothing->nStatus = 1;
    nothing->pszErrBuf = CPLStrdup(fmt::format("{}: the network is closed", url).c_str());
    return nothing;
}

// Before one of GDAL's file systems on the network.
class Gate : public VSIFilesystemHandler {
public:
    explicit Gate(VSIFilesystemHandler* behind) : behind_(behind) {}

    VSIVirtualHandle* Open(const char* name, const char* access, bool tell,
                           CSLConstList options) override {
        if (!refused(name)) return behind_->Open(name, access, tell, options);
        errno = EACCES;
        return nullptr;
    }
    int Stat(const char* name, VSIStatBufL* stat, int flags) override {
        if (!refused(name)) return behind_->Stat(name, stat, flags);
        errno = EACCES;
        return -1;
    }
    char** ReadDirEx(const char* name, int most) override {
        return refused(name) ? nullptr : behind_->ReadDirEx(name, most);
    }
    char** SiblingFiles(const char* name) override {
        return refused(name) ? nullptr : behind_->SiblingFiles(name);
    }
    bool IsLocal(const char*) override { return false; }
    bool SupportsSequentialWrite(const char*, bool) override { return false; }
    bool SupportsRandomWrite(const char*, bool) override { return false; }

private:
    VSIFilesystemHandler* behind_;
};

// GDAL's file systems that are files, parts of files or memory. All others get a gate, so that one
// which a later GDAL brings has it too.
constexpr std::array<std::string_view, 9> local = {"/vsimem/",    "/vsizip/",     "/vsigzip/",
                                                   "/vsitar/",    "/vsisubfile/", "/vsisparse/",
                                                   "/vsicached?", "/vsistdout/",  "/vsicrypt/"};

void put_gates() {
    char** prefixes = VSIFileManager::GetPrefixes();
    for (int i = 0; prefixes != nullptr && prefixes[i] != nullptr; ++i) {
        const std::string prefix = prefixes[i];
        if (std::find(local.begin(), local.end(), prefix) != local.end()) continue;
        // GDAL keeps handlers to its end.
        VSIFileManager::InstallHandler(prefix,
                                       new Gate(VSIFileManager::GetHandler(prefix.c_str())));
    }
    CSLDestroy(prefixes);
}

}  // namespace

void close_the_network() {
    static std::once_flag closing;
    std::call_once(closing, [] {
        put_gates();
        CPLHTTPSetFetchCallback(fetch, nullptr);
        OSRSetPROJEnableNetwork(0);
    });
}

Reach::Reach(bool network) : outer_(now) {
    close_the_network();
    now = new State{network, false, {}};
}

Reach::~Reach() {
    delete now;
    now = outer_;
}

const std::string& Reach::refused() { return now->refused; }
bool Reach::asked_a_service() { return now->asked_a_service; }

}  // namespace vfplan
