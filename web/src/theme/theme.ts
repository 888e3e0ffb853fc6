import { createTheme } from "@mantine/core";

/** Only what the machine has: no font and no address from outside is ever fetched. */
export const theme = createTheme({
  fontFamily: 'Inter, "Segoe UI", Roboto, "Helvetica Neue", "Noto Sans", "DejaVu Sans", Arial, sans-serif',
  fontFamilyMonospace: 'ui-monospace, "Cascadia Mono", "DejaVu Sans Mono", monospace',
  primaryColor: "cyan",
  defaultRadius: "md",
  respectReducedMotion: true,
});
