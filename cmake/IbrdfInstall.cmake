# Install and export, so that another project can find_package(ibrdf).
include(CMakePackageConfigHelpers)

# One include root, ibrdf/: src/ibrdf has links to io and solvers in its place.
foreach(folder src/ibrdf/ io solvers)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder}
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/ibrdf
          FILES_MATCHING PATTERN "*.h"
          PATTERN src/ibrdf/io EXCLUDE
          PATTERN src/ibrdf/solvers EXCLUDE
          PATTERN io/exr_layers.h EXCLUDE  # of the library itself
          PATTERN io/exr_memory.h EXCLUDE
          PATTERN io/png_memory.h EXCLUDE
          PATTERN solvers/bench EXCLUDE
          PATTERN solvers/programs EXCLUDE)
endforeach()
install(EXPORT ibrdfTargets NAMESPACE ibrdf::
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/ibrdf)
configure_package_config_file(cmake/ibrdf-config.cmake.in
  ${PROJECT_BINARY_DIR}/ibrdf-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/ibrdf)
write_basic_package_version_file(
  ${PROJECT_BINARY_DIR}/ibrdf-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/ibrdf-config.cmake
              ${PROJECT_BINARY_DIR}/ibrdf-config-version.cmake
              cmake/FindOpenCVImgproc.cmake cmake/FindOpenEXR.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/ibrdf)
install(DIRECTORY models DESTINATION ${CMAKE_INSTALL_DATADIR}/ibrdf OPTIONAL
        FILES_MATCHING PATTERN "*.ibrdf" PATTERN "*.md" PATTERN "*.txt")
