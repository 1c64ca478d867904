#pragma once
// A picture on its way, shown in tev (https://github.com/Tom94/tev) or what else speaks its protocol.

#include <cstdint>
#include <string>
#include <vector>

#include "core/image.h"

namespace vkcppm {

/// Where a viewer listens.
struct LiveAddress {
    std::string host;
    std::string port;

    std::string text() const;  // HOST:PORT, or [HOST]:PORT where the host has colons
};

/// A viewer of one picture. It may come and go: no failure is an error, the first of a row is a warning.
class LiveView {
public:
    /// name: of the picture there.
    LiveView(LiveAddress address, std::string name);
    LiveView(const LiveView&) = delete;
    LiveView& operator=(const LiveView&) = delete;
    ~LiveView();

    /// Sends the picture, and first its size and channels where the viewer does not know them yet. Takes some seconds
    /// at most where the viewer does not answer.
    void show(const Image& image);

private:
    void send(const std::string& message);

    LiveAddress address_;
    std::string name_;
    int socket_ = -1;
    bool warned_ = false;
};

/// The messages of the protocol: one that makes a picture of channels R, G and B, and those that fill it, tile by tile.
std::string create_message(const std::string& name, Extent extent);
std::vector<std::string> update_messages(const std::string& name, const Image& image);

}  // namespace vkcppm
