# What every target of this project shares: warnings, sanitizers, and kernels
# compiled once per instruction set.

add_library(ibrdf_warnings INTERFACE)
target_compile_options(ibrdf_warnings INTERFACE -Wall -Wextra -Wpedantic
                       -Wshadow -Wno-psabi)
if(IBRDF_WARNINGS_AS_ERRORS)
  target_compile_options(ibrdf_warnings INTERFACE -Werror)
endif()
if(IBRDF_SANITIZE)
  add_compile_options(-fsanitize=address,undefined -fno-omit-frame-pointer
                      -fno-sanitize-recover=undefined
                      # GCC: instrumented code gives false positives
                      -Wno-maybe-uninitialized)
  if(IBRDF_SANITIZE_LEAVE_OUT)
    add_compile_options(-fno-sanitize=${IBRDF_SANITIZE_LEAVE_OUT})
  endif()
  add_link_options(-fsanitize=address,undefined)
endif()
if(IBRDF_BUILD_FUZZERS)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "IBRDF_BUILD_FUZZERS needs Clang, for libFuzzer: "
                        "-DCMAKE_CXX_COMPILER=clang++")
  endif()
  # Everything counts its branches; the fuzzers alone have libFuzzer's main.
  set(fuzz_flags -fsanitize=fuzzer-no-link,address,undefined
                 -fno-sanitize-recover=undefined)
  add_compile_options(${fuzz_flags} -fno-omit-frame-pointer)
  add_link_options(${fuzz_flags})
endif()
add_compile_definitions($<$<CONFIG:Debug>:EIGEN_INITIALIZE_MATRICES_BY_NAN>)

# The headers that most files of `target` read, in place of once for each file,
# where half of the time to compile it goes. Files include what they use all the
# same: the preset `tidy` compiles them without.
function(ibrdf_precompile_headers target)
  if(IBRDF_PRECOMPILE_HEADERS)
    target_precompile_headers(${target} PRIVATE <algorithm> <cmath>
      <functional> <map> <memory> <optional> <string> <vector> ${ARGN})
  endif()
endfunction()

# Compiles each file of ARGN (named *_kernels.cc) into `target` once per
# instruction set, in the namespaces ibrdf::portable, ibrdf::avx2 and
# ibrdf::avx512; the caller picks one by ActiveSimdLevel().
function(ibrdf_add_simd_kernels target)
  set(levels portable)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    list(APPEND levels avx2 avx512)
    target_compile_definitions(${target} PUBLIC IBRDF_HAVE_X86_KERNELS)
  endif()
  set(width_portable 4)
  set(width_avx2 8)
  set(width_avx512 16)
  set(flags_portable "")
  set(flags_avx2 -mavx2 -mfma)
  set(flags_avx512 -mavx512f -mavx512dq -mavx512bw -mavx512vl -mfma
                   -mprefer-vector-width=512)
  foreach(level IN LISTS levels)
    set(object ${target}_kernels_${level})
    add_library(${object} OBJECT ${ARGN})
    target_compile_features(${object} PRIVATE cxx_std_17)
    target_include_directories(${object} PRIVATE ${PROJECT_SOURCE_DIR}/src)
    target_compile_options(${object} PRIVATE -O3 -fno-math-errno
                           -fno-trapping-math ${flags_${level}})
    target_compile_definitions(${object} PRIVATE
      IBRDF_SIMD_NAMESPACE=${level} IBRDF_SIMD_WIDTH=${width_${level}})
    set_target_properties(${object} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    target_link_libraries(${object} PRIVATE ibrdf_warnings)
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${object}>)
  endforeach()
endfunction()

# One executable tests/<folder> from its *_test.cc, each TEST a ctest case.
function(ibrdf_add_tests folder)
  file(GLOB sources CONFIGURE_DEPENDS
       ${PROJECT_SOURCE_DIR}/tests/${folder}/*_test.cc)
  if(NOT sources)
    return()
  endif()
  set(name ibrdf_${folder}_test)
  add_executable(${name} ${sources})
  target_link_libraries(${name} PRIVATE ${ARGN} GTest::gtest GTest::gtest_main
                        ibrdf_warnings)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_compile_definitions(${name} PRIVATE
    IBRDF_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  ibrdf_precompile_headers(${name} <Eigen/Dense> <gtest/gtest.h>)
  gtest_discover_tests(${name} TEST_PREFIX ${folder}/ DISCOVERY_TIMEOUT 60)
endfunction()
