// What page.cpp calls, as the worker takes it. Functions, no arrows: the linker's parser knows no others here.
mergeInto(LibraryManager.library, {
  tremie_page_progress: function(time, duration, run) {
    Module["onProgress"](time, duration, run);
  },
  tremie_page_frame: function(time, n, points) {
    Module["onFrame"](time, HEAPF32.slice(points >> 2, (points >> 2) + 4 * n));
  },
  tremie_page_result: function(json) {
    Module["onResult"](UTF8ToString(json));
  },
  tremie_page_error: function(message) {
    Module["onError"](UTF8ToString(message));
  },
});
