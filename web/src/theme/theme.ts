import { createTheme, Loader } from "@mantine/core";

/** Only what the machine has: no font and no address from outside is ever fetched. */
export const theme = createTheme({
  fontFamily: 'Inter, "Segoe UI", Roboto, "Helvetica Neue", "Noto Sans", "DejaVu Sans", Arial, sans-serif',
  fontFamilyMonospace: 'ui-monospace, "Cascadia Mono", "DejaVu Sans Mono", monospace',
  primaryColor: "cyan",
  defaultRadius: "md",
  respectReducedMotion: true,
  components: {
    // A turning ring says in words that something is awaited; a bare span may have no name.
    Loader: Loader.extend({ defaultProps: { role: "img" } }),
  },
});
