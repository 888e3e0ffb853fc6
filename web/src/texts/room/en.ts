export const roomEn = {
  watching: "Watching",
  unknown: "Who is watching is not known at the moment.",
  you: "you",
  role: {
    operator: "operator",
    supervisor: "supervisor",
    viewer: "viewer",
    screen: "theatre screen",
    camera: "camera",
  },
  line: { good: "good line", slow: "slow line", silent: "not answering" },
};

export type RoomTexts = typeof roomEn;
