# What every target of this project shares: warnings, sanitizers, a library per
# folder, a test program per folder, kernels compiled once per instruction set.

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

# Headers that many files read are read once for all targets of a group (half of
# the time to compile a file goes there). Files include what they use all the
# same: the preset `tidy` compiles them without.
#   group  name of the group, which its first target owns
#   ARGN   headers
function(ibrdf_precompile_headers target group)
  if(NOT IBRDF_PRECOMPILE_HEADERS)
    return()
  endif()
  if(TARGET ibrdf_headers_of_${group})
    get_target_property(owner ibrdf_headers_of_${group} OWNER)
    target_precompile_headers(${target} REUSE_FROM ${owner})
  else()
    target_precompile_headers(${target} PRIVATE <algorithm> <cmath>
      <functional> <map> <memory> <optional> <string> <vector> ${ARGN})
    add_library(ibrdf_headers_of_${group} INTERFACE)
    set_target_properties(ibrdf_headers_of_${group} PROPERTIES OWNER ${target})
  endif()
endfunction()

# The library ibrdf::<name> of the folder it is called in.
#   SOURCES      its files, all of them
#   KERNELS      those compiled once per instruction set
#   PUBLIC       what its headers include
#   PRIVATE      what its sources include besides
#   NO_INSTALL   for the project's own programs alone
# A library without sources is its headers.
function(ibrdf_add_library name)
  cmake_parse_arguments(arg "NO_INSTALL" "" "SOURCES;KERNELS;PUBLIC;PRIVATE"
                        ${ARGN})
  set(target ibrdf_lib_${name})
  if(NOT arg_SOURCES)
    add_library(${target} INTERFACE)
    target_compile_features(${target} INTERFACE cxx_std_17)
    target_link_libraries(${target} INTERFACE ${arg_PUBLIC})
    set(scope INTERFACE)
  else()
    add_library(${target} STATIC ${arg_SOURCES})
    target_compile_features(${target} PUBLIC cxx_std_17)
    target_link_libraries(${target} PUBLIC ${arg_PUBLIC}
      PRIVATE ${arg_PRIVATE} $<BUILD_INTERFACE:ibrdf_warnings>)
    # Half of the time to compile. Eight files: more leave a core idle at the end.
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON
                          UNITY_BUILD ${IBRDF_UNITY_BUILD}
                          UNITY_BUILD_BATCH_SIZE 8)
    set(scope PUBLIC)
    if(CMAKE_CURRENT_SOURCE_DIR MATCHES "/solvers/")
      ibrdf_precompile_headers(${target} solvers <Eigen/Dense>
                               <ceres/ceres.h> <glog/logging.h>)
    else()
      ibrdf_precompile_headers(${target} core <Eigen/Dense> <glog/logging.h>)
    endif()
    if(arg_KERNELS)
      ibrdf_add_simd_kernels(${target} ${arg_KERNELS})
    endif()
  endif()
  add_library(ibrdf::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name}
                        OUTPUT_NAME ibrdf_${name})
  target_include_directories(${target} ${scope}
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  if(NOT arg_NO_INSTALL)
    install(TARGETS ${target} EXPORT ibrdfTargets
            ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  endif()
endfunction()

# The libraries ARGN under one name, for users of many of them.
function(ibrdf_add_umbrella name)
  list(TRANSFORM ARGN PREPEND ibrdf:: OUTPUT_VARIABLE parts)
  add_library(ibrdf_all_${name} INTERFACE)
  add_library(ibrdf::${name} ALIAS ibrdf_all_${name})
  set_target_properties(ibrdf_all_${name} PROPERTIES EXPORT_NAME ${name})
  target_link_libraries(ibrdf_all_${name} INTERFACE ${parts})
  install(TARGETS ibrdf_all_${name} EXPORT ibrdfTargets)
endfunction()

# Compiles each file of ARGN (named *_kernels.cc) into `target` once per
# instruction set, in the namespaces ibrdf::portable, ibrdf::avx2 and
# ibrdf::avx512; the caller picks one by ActiveSimdLevel().
function(ibrdf_add_simd_kernels target)
  set(levels portable)
  if(IBRDF_X86)
    list(APPEND levels avx2 avx512)
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

# The program ibrdf_<folder>_test of tests/<folder>, each TEST a ctest case.
#   SOURCES    its files, all of them
#   LIBRARIES  what they test and use
function(ibrdf_add_tests folder)
  cmake_parse_arguments(arg "" "" "SOURCES;LIBRARIES;PROPERTIES" ${ARGN})
  list(TRANSFORM arg_SOURCES PREPEND ${PROJECT_SOURCE_DIR}/tests/${folder}/)
  set(name ibrdf_${folder}_test)
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE ${arg_LIBRARIES} GTest::gtest
                        GTest::gtest_main ibrdf_warnings)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}
                             ${PROJECT_SOURCE_DIR}/src)
  target_compile_definitions(${name} PRIVATE
    IBRDF_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  # Four files: most folders have four to eight, and both cores stay busy.
  set_target_properties(${name} PROPERTIES UNITY_BUILD ${IBRDF_UNITY_BUILD}
                        UNITY_BUILD_BATCH_SIZE 4)
  ibrdf_precompile_headers(${name} tests <Eigen/Dense> <gtest/gtest.h>)
  gtest_discover_tests(${name} TEST_PREFIX ${folder}/ DISCOVERY_TIMEOUT 60
                       PROPERTIES ${arg_PROPERTIES})
endfunction()
