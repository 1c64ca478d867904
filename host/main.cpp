#include "app/run.h"

int main(int argc, char** argv) { return vkcppm::run(argc, argv); }
