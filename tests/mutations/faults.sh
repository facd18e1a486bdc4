# Deliberate faults, sourced by run.sh: fault DESCRIPTION FILE OLD NEW EXECUTABLE TESTS. OLD stands in FILE just once.
# Neighbours in this list share files, which saves building.

# The trees and their builders.
fault "the sweep forgets who began" tracer/compiled/kdtree/sweep.cpp \
    'below += start;' 'below += 1;' \
    hierarchy_tests 'KdSweep.FindsTheCheapestOfAllPlanes'
fault "the sweep skips a stretch that holds the best plane" tracer/compiled/kdtree/sweep.cpp \
    'if (bound <= std::min(cheapest_between, sweep.best.cost))' 'if (bound * 1.2 <= std::min(cheapest_between, sweep.best.cost))' \
    hierarchy_tests 'KdSweep.FindsTheCheapestOfAllPlanes'
fault "clipping keeps what is outside" tracer/compiled/kdtree/clip.cpp \
    'polygon = clipped(polygon, axis, -1, box.upper[axis]);' 'polygon = clipped(polygon, axis, -1, whole.upper[axis]);' \
    hierarchy_tests 'KdClip.IsPerfect*'
fault "clipping loses a bit of a sphere" tracer/compiled/kdtree/clip.cpp \
    'const double reach = std::sqrt(room) + margin;' 'const double reach = std::sqrt(room) * 0.999;' \
    hierarchy_tests 'KdClip.LosesNoPointOfASpheresSurface'
fault "boxes of a split's sides overlap by a bin" tracer/compiled/bvh/binning.cpp \
    '(i < plane.bin ? lower : upper)' '(i < plane.bin - 1 ? lower : upper)' \
    hierarchy_tests '*Invariants.HoldForTheBvh*'

# Parsers.
fault "numbers may lie below their range" tracer/files/scene_text/values.cpp \
    'value < least || value > most)' 'value > most)' \
    files_tests '*BadFile*'
fault "infinity is a number" tracer/files/scene_text/values.cpp \
    'std::isnan(value) || text.find_first_of("iI") != std::string_view::npos' 'std::isnan(value)' \
    files_tests '*BadFile*'
fault "more values than wanted are passed over" tracer/files/scene_text/values.cpp \
    'if (!failed_ && more()) {' 'if (false) {' \
    files_tests '*BadFile*'
fault "negative indices are off by one" tracer/files/mesh/obj_chunk.cpp \
    'static_cast<std::uint32_t>(count) - value)' 'static_cast<std::uint32_t>(count) - value + 1)' \
    files_tests 'ObjTest.EveryIndexFormNamesTheSameTriangle'
fault "polygons are strips" tracer/files/mesh/obj_chunk.cpp \
    'if (count == 0) first = corner;' 'first = previous;' \
    files_tests 'ObjTest.PolygonsAreFansFromTheirFirstCorner'
fault "a byte order mark is part of a word" tracer/files/mesh/obj_chunk.cpp \
    'if (word.starts_with(byte_order_mark)) {' 'if (false) {' \
    files_tests 'ObjFlaws.AByteOrderMarkLosesNoVertex'
fault "names are continued" tracer/files/mesh/obj_chunk.cpp \
    'word == "vt" || is_number_statement(word)' 'word == "vt" || is_number_statement(word) || is_name_statement(word)' \
    files_tests 'ObjFlaws.ABackslashOfANameOrACommentContinuesNothing'
fault "blanks behind a backslash end its line" tracer/files/mesh/obj_cursor.cpp \
    'while (is_blank(*newline)) ++newline;' 'while (*newline == 13) ++newline;' \
    files_tests 'ObjTest.EveryIndexFormNamesTheSameTriangle'
fault "comments need a blank before them" tracer/files/mesh/obj_words.cpp \
    "(stop == at || is_digit(stop[-1]) || stop[-1] == '/')" '(stop == at)' \
    files_tests 'ObjFlaws.CommentsBehindDataAreIgnored'
fault "vertices that cannot be read have no number" tracer/files/mesh/obj_chunk.cpp \
    'out_.positions.emplace_back(std::numeric_limits<float>::quiet_NaN());' '' \
    files_tests 'ObjFlaws.AVertexThatCannotBeReadKeepsItsNumber'
fault "carriage returns end no line" tracer/files/mesh/obj_reader.cpp \
    'if (chunk->lone_returns) {' 'if (false) {' \
    files_tests 'ObjFlaws.CarriageReturnsEndLines'
fault "normals that cannot be read count" tracer/files/mesh/obj_reader.cpp \
    'flaws_.count(ObjFlaw::empty_normal) + flaws_.count(ObjFlaw::normal)' 'flaws_.count(ObjFlaw::empty_normal)' \
    files_tests 'ObjFlaws.NormalsThatAreNoneComeFromTheFaces'
fault "vertices that no face names are kept" tracer/files/mesh/obj_reader.cpp \
    'if (unnamed_ == 0) return;' 'return;' \
    files_tests 'ObjFlaws.VerticesThatNoFaceNamesAreLeftOut'
fault "a guessed origin stays" tracer/files/mesh/obj_reader.cpp \
    'return wanted_far && is_far && good' 'return is_far && good' \
    files_tests 'ObjOrigin.MeshesNearTheOriginKeepTheirBits'
fault "maps are near the origin" tracer/files/mesh/obj_origin.cpp \
    'constexpr double far = 16;' 'constexpr double far = 1e9;' \
    files_tests 'ObjOrigin.MeshesInCoordinatesOfAMapAreNotRoundedToSteps'
fault "every fan fits" tracer/files/mesh/polygons.cpp \
    'return least < -0x1p-22 * largest * reach;' 'return false;' \
    files_tests 'Polygons.ConcaveOnesAreFilled'
fault "corners on an ear's border are passed over" tracer/files/mesh/ear_clipping.cpp \
    'if (!touching_blocks_) return false;' 'return false;' \
    files_tests 'Polygons.*'
fault "neighbours wound alike are told apart" tracer/compiled/winding.cpp \
    'turned[face] ^ (same_direction(mesh, edge, other) ? 1 : 0)' 'turned[face] ^ 1' \
    compiled_tests 'Winding.*'
fault "closed meshes point inwards" tracer/compiled/winding.cpp \
    'if (volume < 0 ||' 'if (volume > 0 ||' \
    compiled_tests 'Winding.FacesOfAClosedMeshPointOutwards'

# Writers of pictures.
fault "pictures hold the date" helpers/image/openimageio.cpp \
    'spec.attribute("DateTime", "");' '' \
    files_tests 'ImageWriting.NoFormatHoldsTheDate'
fault "negative values and infinity go into an HDR" helpers/image/openimageio.cpp \
    'value = value > 0 ? std::min(value, largest) : 0.0f;' '(void)value;' \
    files_tests 'ImageWriting.HdrHasNoNegativeOrEndlessValues'
fault "whoever waits for a picture waits for its compression" helpers/image/openimageio.cpp \
    'picture.urgent ? "none" : "zip:3"' '"zip:3"' \
    files_tests 'ImageWriting.UrgentFloatsAreNotCompressed'
fault "kept bytes of a picture go to the wrong place" helpers/image/encoded_file.cpp \
    'if (kept_.empty()) kept_at_ = offset;' '' \
    files_tests 'ImageWriting/FloatFormat.HoldsEveryBitUrgentOrNot/0'
fault "a picture that was not encoded replaces the old one" tracer/files/image/write.cpp \
    'if (!problem.empty()) throw' 'if (false) throw' \
    command_line_tests 'CommandLine.AnEncoderThatBreaksEndsWithOneAndKeepsTheOldPicture'
fault "a missing encoder is noticed when the picture is done" tracer/files/image/write.cpp \
    'extension && extension->format ? obstacle_to_encoding(*extension->format) : std::string()' 'std::string()' \
    command_line_tests 'CommandLine.AMissingEncoderIsNoticedBeforeTheWork'
fault "nobody is told that a picture is being saved" app/process/interrupts.cpp \
    'if (flag) say' 'if (false) say' \
    command_line_tests 'CommandLine.AnInterruptSavesWhatThereIsAndEndsWith130'

# Film, camera and walk.
fault "a cleared film keeps its samples" tracer/picture/film.cpp \
    'std::fill(samples.begin(), samples.end(), 0)' '(void)0' \
    rendering_tests 'Film.*:Renderer.OnlyAChangeOfTheViewRestarts'
fault "normalising brightens dark pictures" tracer/picture/film.cpp \
    'float largest = 1;' 'float largest = 0;' \
    rendering_tests 'Film.NormalizingBringsTheLargestChannelToOneAndNeverBrightens'
fault "the mean is a sum" tracer/picture/film.cpp \
    'film.tiles[tile].rgb[channel][lane] * scale;' 'film.tiles[tile].rgb[channel][lane];' \
    rendering_tests 'Film.MeanRadianceIsTheSumOverTheSamplesWithRowsFromTheTop'
fault "toggled twice is orthographic" tracer/picture/camera.cpp \
    'camera.projection == Projection::perspective ? Projection::orthographic : Projection::perspective' \
    'Projection::orthographic' \
    rendering_tests 'Camera.TheProjectionToggledTwiceIsTheSameCamera'
fault "the view goes over the top" app/walk/walk.cpp \
    'std::clamp(pitch + pitch_change, -limit, limit)' 'pitch + pitch_change' \
    app_tests 'Walk.PitchStopsAt89Degrees'
fault "a step of a turned view goes the old way" app/walk/walk.cpp \
    'Camera other = turned(camera, yaw / 2, pitch / 2);' 'Camera other = camera;' \
    app_tests 'Walk.*'
fault "counts in a walk script are passed over" app/walk/walk_script.cpp \
    'counted ? count : 1' '1' \
    app_tests 'WalkScript.*'
fault "[ brightens too" app/walk/walk.cpp \
    'WalkKey::darker ? -1 : 0' 'WalkKey::darker ? 1 : 0' \
    app_tests 'Walk.PressesOfTheExposureAddUpAndMultiply'
fault "pictures are as bright whatever the keys" app/render_command.cpp \
    'exposure_factor(exposure_presses(options.keys))' 'exposure_factor(0)' \
    command_line_tests 'CommandLine.KeysOfTheExposureScaleIt'
fault "a forgotten value swallows the next option" app/command_line/options.cpp \
    "word.starts_with('-') && app.get_option_no_throw(word) != nullptr" 'false' \
    app_tests 'Options.WhatIsMissingIsNamed'
fault "the values of switches are passed over" app/command_line/options.cpp \
    'option->get_items_expected_max() == 0' 'false' \
    app_tests 'Options.WhatIsTooMuchIsNamed'

# Kernels: what rays hit.
fault "triangles reach beyond their third edge" tracer/kernels/traversal/ray_shapes.h \
    'r.u + r.v <= Real(1.0f) + slack' 'r.u + r.v <= Real(1.1f)' \
    traversal_tests '*FindsTheHitsThatALoop*'
fault "triangles leave gaps" tracer/kernels/traversal/ray_shapes.h \
    'min(r.u, r.v) >= -slack' 'min(r.u, r.v) >= slack' \
    traversal_tests '*LetsNoRayOutOfAClosedMesh*'
fault "no ray starts inside a sphere" tracer/kernels/traversal/ray_shapes.h \
    'select(first > t_min, first, middle + half)' 'first' \
    traversal_tests '*FindsTheHitsThatALoop*'
fault "of equal hits the last counts" tracer/kernels/traversal/ray_shapes.h \
    'distance[l] == hit.t && id >= hit.id' 'distance[l] == hit.t && id == hit.id' \
    traversal_tests 'TraversalBits.*'
fault "a beam is not as wide as its rays" tracer/kernels/traversal/beam.h \
    'beam.u1 = -wider(least[1])' 'beam.u1 = wider(least[0])' \
    traversal_tests '*FindsTheHitsThatALoop*'
fault "beams end at the nearest hit of their rays" tracer/kernels/traversal/beam.h \
    'reduce_max(depth, beam.group_depth)' 'reduce_min(depth, beam.group_depth)' \
    traversal_tests '*FindsTheHitsThatALoop*'
fault "rays of a stream are lost with the last group" tracer/kernels/traversal/stream_traversal.h \
    'g < packet_groups; ++g)' 'g < packet_groups - 1; ++g)' \
    traversal_tests '*FindsTheHitsThatALoop*'
fault "the farthest child of a stream comes first, and the rest never" tracer/kernels/traversal/stream_traversal.h \
    'while (!stack.empty())' 'while (!stack.empty() && done == 0 && stack.size() < 2)' \
    traversal_tests '*FindsTheHitsThatALoop*'

# Kernels: how it looks.
fault "light fades too fast" tracer/kernels/shading/phong.h \
    'attenuation = 0.02f' 'attenuation = 0.0201f' \
    shading_tests 'Shading.LightFadesByTheLengthOfItsWholePath'
fault "the highlight lies elsewhere" tracer/kernels/shading/phong.h \
    'mul_sub(cosine * Real(2.0f)' 'mul_sub(cosine * Real(1.9f)' \
    shading_tests 'Shading.PhongAtAKnownAngle'
fault "mirrors are bent" tracer/kernels/whitted/spawn.h \
    'Real(-2.0f) * dot' 'Real(-1.99f) * dot' \
    shading_tests 'Shading.MirrorShowsTheVirtualImage'
fault "glass bends the wrong way" tracer/kernels/whitted/spawn.h \
    'eta = medium / index' 'eta = index / medium' \
    shading_tests 'Shading.GlassSphereBendsRaysBySnellsLaw'
fault "total reflection lets light out" tracer/kernels/whitted/spawn.h \
    'active & s.sphere & (squared < Real(0.0f))' 'active & s.sphere & (squared < Real(-9.0f))' \
    shading_tests 'Shading.TotalReflectionReflects'
fault "black and white change places" tracer/kernels/shading/texture.h \
    'select(floor(half) < half, Real(1.0f), Real(0.0f))' 'select(floor(half) < half, Real(0.0f), Real(1.0f))' \
    shading_tests 'Texturing.GridOnASphereFollowsLongitudeAndLatitude'
fault "rows of an image are columns" tracer/kernels/shading/texture.h \
    'cell(a - floor(a), rows) * columns' 'cell(a - floor(a), columns) * rows' \
    shading_tests 'Texturing.ImageShowsTheTexelUnderEveryPoint'
fault "vertex normals at the wrong corners" tracer/kernels/shading/surface.h \
    'mul_add(n2, hit.v, mul_add(n1, hit.u,' 'mul_add(n1, hit.v, mul_add(n2, hit.u,' \
    shading_tests 'SmoothTriangle.*'

# Rounding and smooth meshes.
fault "rays start too near to large balls" tracer/kernels/shading/surface.h \
    'max(s.offset, reach * Real(sphere_offset))' 's.offset' \
    shading_tests 'Rounding.LeavesNoSpecksOnBallsOfAnySize'
fault "rays start too near to large triangles" tracer/compiled/compile.cpp \
    'static_cast<float>(reach) * triangle_offset' 'static_cast<float>(reach) * 0.0f' \
    shading_tests 'Rounding.LeavesNoSpecksOnTrianglesOfAnySize'
fault "scenes stay where they are" tracer/compiled/local_origin.cpp \
    'largest(middle) > far_away * largest(upper - lower)' 'false' \
    shading_tests 'Rounding.AScenesPlaceDoesNotChangeItsPicture'
fault "inward normals stay inward" tracer/kernels/shading/surface.h \
    'select(inward, -outward, outward)' 'outward' \
    shading_tests 'FacetedBall.LooksTheSameWhicheverWayItIsWound'
fault "shadow rays start on flat faces" tracer/kernels/shading/surface.h \
    'select(known & (dot(lift, facing) > zero), lift, s.lift)' 's.lift' \
    shading_tests 'FacetedBall.IsLitWhereItsNormalsFaceTheLight'

# The walk's window.
fault "keys of other alphabets mean nothing" app/display/window.cpp \
    'if (!label.latin || label.text.empty())' 'if (label.text.empty())' \
    window_tests 'Keyboard.*'
fault "the walk leaps after a stall" app/walk/input.h \
    'now_ = std::max(now_, seconds);' 'static_cast<void>(seconds);' \
    window_tests 'Input.ATimeThatTheWalkStoodStillMovesNothing'
fault "a walk that nobody sees goes on" app/walk/render_thread.cpp \
    'return !resting_ &&' 'return' \
    window_tests 'RenderThread.TracesNothingWhileItRests'
fault "the same picture is sampled again and again" app/walk/render_thread.cpp \
    'still_ = picture == compared_;' 'still_ = false;' \
    window_tests 'RenderThread.EndsEarlierWhereTwiceTheSamplesChangeNoValue'
fault "a wrong variable of the driver is not named" app/display/no_display.cpp \
    '{"VK_DRIVER_FILES", "VK_ICD_FILENAMES"}' '{"VK_ICD_FILENAMES"}' \
    window_tests 'Offscreen.NoDriverIsToldWithWhatToDo'

# What a scene may take and reach.
fault "memory of a mesh counts once" tracer/files/memory_budget.cpp \
    'used_.fetch_add(bytes)' 'used_.load()' \
    files_tests 'Budgets.MemoryOfAMeshThatIsNamedOftenCountsEachTime'
fault "time for reading never ends" tracer/files/load.cpp \
    'if (watch.seconds() <= static_cast<double>(limits.seconds)) return;' 'return;' \
    files_tests 'Budgets.TimeForAllFilesEnds'
fault "every parent is a project" tracer/files/scene_folders.cpp \
    'if (std::ranges::find(names, folder.filename()) == names.end()) return false;' 'return true;' \
    files_tests 'SceneFolders.*'
fault "a home is a project" tracer/files/scene_folders.cpp \
    '&& !is_home(parent);' ';' \
    files_tests 'SceneFolders.TheParentCountsWhereItLooksLikeAProject'
fault "links are followed below a folder" tracer/ground/open_beneath.cpp \
    'RESOLVE_BENEATH | RESOLVE_NO_SYMLINKS | RESOLVE_NO_MAGICLINKS' '0' \
    ground_tests 'OpenBeneath.NoLinkIsFollowedOnTheWay'
fault "lines of other people's files are shown" tracer/files/load.cpp \
    'diagnostic.source_line.clear();' '' \
    files_tests 'SceneFolders.LinesOfFilesElsewhereAreNotShown'
fault "the quota of version 1 is not read" tracer/ground/control_groups.cpp \
    'quota = content_of(folder / "cpu.cfs_quota_us");' '' \
    ground_tests 'ControlGroups.VersionOneIsReadAsVersionTwo'
fault "previews have an exposure of their own" app/exposure.cpp \
    'return normalizing_exposure(renderer.film());' 'return {};' \
    command_line_tests 'CommandLine.APreviewIsAsBrightAsThePicture'
fault "a PNG lies as it was held" helpers/image/png.cpp \
    'if (type == "eXIf")' 'if (type == "none")' \
    files_tests 'ImageTest.APngWithAnExifChunkIsTurnedUpright'
fault "a picture that cannot be saved is lost" app/process/saving.cpp \
    'const fs::path file = rescued(output, film);' 'const fs::path file;' \
    command_line_tests 'CommandLine.APictureWhoseFolderIsGoneIsRescued'
fault "outputs overwrite each other" app/process/output_files.cpp \
    'return real_path_of(a) == real_path_of(b);' 'return a == b;' \
    command_line_tests 'CommandLine.OutputsOfOneRunAreDifferentFiles'
