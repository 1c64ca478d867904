// vkcppm_manual FOLDER: writes the manual page and the completions there, for the build.

#include <cstdio>
#include <exception>

#include "app/manual.h"

int main(int argc, char** argv) try {
    if (argc != 2) {
        std::fputs("vkcppm_manual: give the folder to write to\n", stderr);
        return 2;
    }
    vkcppm::write_manual(argv[1]);
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "vkcppm_manual: %s\n", error.what());
    return 1;
}
