export const toolEn = { title: "Tool" };

export type ToolWords = typeof toolEn;
