# Install and export, so that another project can find_package(ibrdf).
include(CMakePackageConfigHelpers)

install(TARGETS ibrdf_core ibrdf_io ibrdf_solvers ibrdf_training
        EXPORT ibrdfTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/src/ibrdf
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(DIRECTORY ${PROJECT_SOURCE_DIR}/io ${PROJECT_SOURCE_DIR}/solvers
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h"
        PATTERN "solvers/bench" EXCLUDE)
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
        FILES_MATCHING PATTERN "*.ibrdf" PATTERN "*.md")
