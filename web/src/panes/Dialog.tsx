import { Modal, type ModalProps } from "@mantine/core";
import { useSyncExternalStore, type ReactNode } from "react";

const MARGIN_PX = 8;

/** A modal dialog below the band of alarms, which stays readable and is touched above the overlay. */
export function Dialog(props: ModalProps): ReactNode {
  const top = useSyncExternalStore(onResize, bandBottomPx) + MARGIN_PX;
  return (
    <Modal
      {...props}
      yOffset={top}
      // A moving dialog would pass over the band.
      transitionProps={{ duration: 0 }}
      styles={{
        inner: { paddingBottom: MARGIN_PX },
        content: { maxHeight: `calc(100dvh - ${String(top + MARGIN_PX)}px)` },
      }}
    />
  );
}

function onResize(listener: () => void): () => void {
  addEventListener("resize", listener);
  return () => {
    removeEventListener("resize", listener);
  };
}

/** Lower edge of the band in the window, which lies below a header of any height; 0 without a band. */
function bandBottomPx(): number {
  const bottom = document.querySelector(".alarms")?.getBoundingClientRect().bottom ?? 0;
  return Math.max(0, Math.round(bottom));
}
