#pragma once
// The Error that a call throws, to look at its code and message.

#include <optional>

#include "core/error.h"

namespace vkcppm::test {

/// The Error that `call` throws; none where it returns.
template <typename Call> std::optional<Error> thrown_by(Call&& call) {
    try {
        call();
    } catch (const Error& error) {
        return error;
    }
    return std::nullopt;
}

}  // namespace vkcppm::test
