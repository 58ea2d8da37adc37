# SPDX-License-Identifier: Apache-2.0
# altiplan_api_hash(FOLDER FILE): writes the header FILE with one hash over the declarations in the
# headers of FOLDER, in which no comment and no space counts. The host refuses plugins that were built
# with another one.
function(altiplan_api_hash folder file)
  file(GLOB headers ${folder}/*.hpp)
  list(REMOVE_ITEM headers ${file})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${folder} ${headers})
  set(declarations)
  foreach(header IN LISTS headers)
    file(READ ${header} text)
    string(REGEX REPLACE "//[^\n]*|[ \t\r\n]" "" text "${text}")
    string(APPEND declarations "${text}")
  endforeach()
  string(SHA256 hash "${declarations}")
  string(SUBSTRING ${hash} 0 16 hash)
  file(CONFIGURE OUTPUT ${file} CONTENT "// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Of the declarations in the headers beside this one, in which no comment and no space counts.
#define ALTIPLAN_API_HASH \"${hash}\"
")
endfunction()
