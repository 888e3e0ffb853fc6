import { createTheme, Loader } from "@mantine/core";
import { decimalSign } from "../live/rounding";

/** System fonts only: nothing is fetched from outside. */
export const theme = createTheme({
  fontFamily: 'Inter, "Segoe UI", Roboto, "Helvetica Neue", "Noto Sans", "DejaVu Sans", Arial, sans-serif',
  fontFamilyMonospace: 'ui-monospace, "Cascadia Mono", "DejaVu Sans Mono", monospace',
  primaryColor: "cyan",
  // White text on the next lighter shade has a contrast of 4.3, which is too little.
  primaryShade: 9,
  // Black or white text on filled buttons, whichever has the larger contrast.
  autoContrast: true,
  luminanceThreshold: 0.18,
  defaultRadius: "md",
  respectReducedMotion: true,
  components: {
    // A point and a comma are accepted in either language.
    NumberInput: {
      defaultProps: () => ({ decimalSeparator: decimalSign(), allowedDecimalSeparators: [".", ","] }),
    },
    // The spinner needs a role, because a bare span may not have a label.
    Loader: Loader.extend({ defaultProps: { role: "img" } }),
  },
});
