# cmake -P words.cmake IN OUT: writes the little-endian 32-bit words of a file as C++ has them in a list, one a line.
file(READ ${CMAKE_ARGV3} bytes HEX)
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1,\n" words "${bytes}")
file(WRITE ${CMAKE_ARGV4} "${words}")
