# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

# Script that adds inherited properties to the help page of a proxy with `base_proxyname`. ParaView writes
# only the properties in the XML of the proxy. A second run changes nothing.
#   cmake -DBASE=filters.DeformableSurface.html -DPAGE=filters.VolumeToSurface.html -P ...

cmake_minimum_required(VERSION 3.18)

# volumic_read_page(PREFIX FILE): set PREFIX_names to the properties in the table of a page,
# PREFIX_row_<name> to their rows, and PREFIX_before and PREFIX_after to the text around the rows.
function (volumic_read_page prefix file)
  file(READ "${file}" text)
  string(FIND "${text}" "</tr>" head) # the row of titles
  string(FIND "${text}" "</table>" end REVERSE)
  if (head EQUAL -1 OR end EQUAL -1)
    message(FATAL_ERROR "${file} is not a help page of ParaView")
  endif ()
  math(EXPR head "${head} + 5")
  string(SUBSTRING "${text}" 0 ${head} before)
  set("${prefix}_before" "${before}" PARENT_SCOPE)
  math(EXPR length "${end} - ${head}")
  string(SUBSTRING "${text}" ${head} ${length} rows)
  string(SUBSTRING "${text}" ${end} -1 after)
  set(names)
  string(FIND "${rows}" "</tr>" length)
  while (NOT length EQUAL -1)
    math(EXPR length "${length} + 5")
    string(SUBSTRING "${rows}" 0 ${length} row)
    string(SUBSTRING "${rows}" ${length} -1 rows)
    if (NOT row MATCHES "<th>([^<]*)</th>")
      message(FATAL_ERROR "${file} has a row without a property")
    endif ()
    list(APPEND names "${CMAKE_MATCH_1}")
    set("${prefix}_row_${CMAKE_MATCH_1}" "${row}" PARENT_SCOPE)
    string(FIND "${rows}" "</tr>" length)
  endwhile ()
  set("${prefix}_names" "${names}" PARENT_SCOPE)
  set("${prefix}_after" "${rows}${after}" PARENT_SCOPE)
endfunction ()

volumic_read_page(base "${BASE}")
volumic_read_page(page "${PAGE}")
set(text "${page_before}")
foreach (name IN LISTS base_names)
  if (name IN_LIST page_names)
    string(APPEND text "${page_row_${name}}")
  else ()
    string(APPEND text "${base_row_${name}}")
  endif ()
endforeach ()
foreach (name IN LISTS page_names)
  if (NOT name IN_LIST base_names)
    string(APPEND text "${page_row_${name}}")
  endif ()
endforeach ()
file(WRITE "${PAGE}" "${text}${page_after}")
