import { Alert } from "@mantine/core";
import type { ReactNode } from "react";
import { Link } from "wouter";
import { useLive } from "../../live/LiveContext";
import { useWords } from "../../words/WordsContext";

/** Camera or patient moved: what that ends, and the way back. */
export function Moved(): ReactNode {
  const words = useWords().navigate;
  const watched = useLive().view.newest?.snapshot?.motion;
  if (!watched) return null;
  const moves = [
    { key: "camera", is: watched.camera_moved, words: words.cameraMoved, href: "/operator/register" },
    { key: "reference", is: watched.reference_moved, words: words.referenceMoved, href: "/operator/check" },
  ].filter((one) => one.is);
  return moves.map((one) => (
    <Alert
      key={one.key}
      className="rejection"
      role="alert"
      title={one.words.title}
      data-testid={`moved-${one.key}`}
    >
      {one.words.remedy}{" "}
      <Link className="big-link" href={one.href}>
        {one.words.go}
      </Link>
    </Alert>
  ));
}
