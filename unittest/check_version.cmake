# cmake -DVERSION=<of CMakeLists.txt> -DTOP=<dir> -P check_version.cmake
# CITATION.cff and the newest entry of CHANGELOG.md must have the version of CMakeLists.txt.
file(STRINGS ${TOP}/CITATION.cff citation REGEX "^version:")
if(NOT citation STREQUAL "version: ${VERSION}")
  message(SEND_ERROR "CITATION.cff has '${citation}', but CMakeLists.txt has version ${VERSION}")
endif()
file(STRINGS ${TOP}/CHANGELOG.md entries REGEX "^## \\[")
list(GET entries 0 newest)
string(FIND "${newest}" "## [${VERSION}]" place)
if(NOT place EQUAL 0)
  message(SEND_ERROR "CHANGELOG.md begins with '${newest}', but CMakeLists.txt has version ${VERSION}")
endif()
