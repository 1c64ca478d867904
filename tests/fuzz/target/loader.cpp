// libFuzzer over misbehaviour(): tests/fuzz/README.md says how it is run.

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "support/hostile/hostile_input.h"
#include "support/hostile/mutation.h"

using namespace vkcppm::test;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string found = misbehaviour(std::string(reinterpret_cast<const char*>(data), size));
    if (found.empty()) return 0;
    std::fprintf(stderr, "misbehaviour: %s\n", found.c_str());
    std::abort();
}

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

/// Half of the time libFuzzer's own mutations, which follow what it has learned of comparisons; half of the time ours,
/// which know JSON.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
    if (seed % 2 == 0) return LLVMFuzzerMutate(data, size, most);
    const std::string mutated = mutation(std::string(reinterpret_cast<char*>(data), size), seed);
    if (mutated.empty() || mutated.size() > most) return LLVMFuzzerMutate(data, size, most);
    std::memcpy(data, mutated.data(), mutated.size());
    return mutated.size();
}
