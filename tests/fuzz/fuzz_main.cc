// libFuzzer's entry for the parser IBRDF_FUZZ_PARSER.
#include "tests/fuzz/parsers.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  ibrdf::FuzzParser(IBRDF_FUZZ_PARSER, data, size);
  return 0;
}
