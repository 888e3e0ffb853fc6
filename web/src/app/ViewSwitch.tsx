import type { ReactNode } from "react";
import { Link, useLocation } from "wouter";
import { useWords } from "../words/WordsContext";
import { useSession } from "./session";
import { PATHS, viewAt, viewsOf } from "./views";

/** The views that this role may choose from; nothing where there is but one. */
export function ViewSwitch(): ReactNode {
  const words = useWords().shell;
  const { session } = useSession();
  const [path] = useLocation();
  if (session.state !== "in") return null;
  const views = viewsOf(session.who.role);
  if (views.length < 2) return null;
  const now = viewAt(path, session.who.role);
  return (
    <nav className="views" aria-label={words.views}>
      {views.map((view) => (
        <Link key={view} href={PATHS[view]} aria-current={view === now ? "page" : undefined}>
          {words.view[view]}
        </Link>
      ))}
    </nav>
  );
}
