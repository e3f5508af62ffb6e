# OpenEXR's own package files, without the notes of Debian's Imath on its Python
# module, which its package does not depend on and this project does not use.
# Defines OpenEXR::OpenEXR.
set(_ibrdf_log_level "${CMAKE_MESSAGE_LOG_LEVEL}")
set(CMAKE_MESSAGE_LOG_LEVEL WARNING)
find_package(OpenEXR ${OpenEXR_FIND_VERSION} QUIET CONFIG)
set(CMAKE_MESSAGE_LOG_LEVEL "${_ibrdf_log_level}")
unset(_ibrdf_log_level)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenEXR CONFIG_MODE)
