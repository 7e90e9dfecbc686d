# Writes a C++ source with the files of golden/.
# usage: cmake -DFOLDER=golden -DOUTPUT=golden_bytes.cpp -P embed_golden.cmake
cmake_minimum_required(VERSION 3.22)

set(source "// Made by embed_golden.cmake from the files in apps/conformance/golden.
#include \"apps/conformance/golden_bytes.h\"

namespace mien::conformance {
")
foreach(pair
    MiniFile=mini.mien EncoderInput=encoder_input.f32 EncoderOutput=encoder_output.f32
    PnetInput=pnet_input.f32 PnetOutput0=pnet_output0.f32 PnetOutput1=pnet_output1.f32
    TemporalInput=temporal_input.f32 TemporalOutput=temporal_output.f32)
  string(REGEX MATCH "^([^=]+)=(.+)$" ignored ${pair})
  set(name ${CMAKE_MATCH_1})
  file(READ "${FOLDER}/${CMAKE_MATCH_2}" hex HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
  string(APPEND source "
alignas(64) static const unsigned char bytes_of_${name}[] = {${bytes}};
const Embedded k${name}{bytes_of_${name}, sizeof bytes_of_${name}};
")
endforeach()
string(APPEND source "\n}  // namespace mien::conformance\n")
file(WRITE "${OUTPUT}" "${source}")
