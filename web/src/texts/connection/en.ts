export const connectionEn = {
  size: "Picture size",
  sizes: { auto: "Auto", full: "Full", half: "Half", quarter: "Quarter" },
  thin: "Thin line",
  server: "Slow server",
  decoding: "Slow decoding",
  drawing: "Slow drawing",
  reduced: "Reduced picture",
  rate: "images/s",
  ages: "How old everything is",
  age: { picture: "Picture", numbers: "Numbers", scene: "3-D", clock: "Clock of the server, ahead by" },
};

export type ConnectionTexts = typeof connectionEn;
