/* Linked into sanitized programs only: dlclose does nothing.
 *
 * The Vulkan loader unloads the driver before LeakSanitizer looks at the process. The driver's leaks then have no
 * module name, so that no suppression could tell them from ours. With the libraries kept, each leak is named. */
__attribute__((visibility("default"))) int dlclose(void* handle);
int dlclose(void* handle) {
  (void)handle;
  return 0;
}
