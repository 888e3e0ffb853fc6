export const connectionEn = {
  size: "Picture size",
  sizes: { auto: "Auto", full: "Full", half: "Half", quarter: "Quarter" },
  thin: "Slow connection",
  server: "Slow server",
  decoding: "Slow decoding",
  drawing: "Slow drawing",
  reduced: "Reduced picture",
  rate: { one: "{count} image/s", other: "{count} images/s" },
  ages: "Age of the display",
  age: { picture: "Picture", numbers: "Numbers", scene: "3-D", clock: "Server clock ahead by" },
};

export type ConnectionTexts = typeof connectionEn;
