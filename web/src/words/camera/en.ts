export const cameraEn = { title: "Camera" };

export type CameraWords = typeof cameraEn;
