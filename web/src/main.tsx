import "@mantine/core/styles/baseline.css";
import "@mantine/core/styles/default-css-variables.css";
import "@mantine/core/styles/global.css";
import "@mantine/core/styles/UnstyledButton.css";
import "@mantine/core/styles/CloseButton.css";
import "@mantine/core/styles/Alert.css";
import "@mantine/core/styles/Table.css";
import "./theme/page.css";
import "./theme/panes.css";

import { MantineProvider } from "@mantine/core";
import { StrictMode } from "react";
import { createRoot } from "react-dom/client";
import { LiveProvider } from "./live/LiveContext";
import { Page } from "./Page";
import { theme } from "./theme/theme";
import { wordsFor } from "./words/choose";
import { WordsProvider } from "./words/WordsContext";

const words = wordsFor(location.search, navigator.languages);
document.documentElement.lang = words.language;
const root = document.getElementById("root");
if (root === null) throw new Error("index.html has no #root");

createRoot(root).render(
  <StrictMode>
    <MantineProvider theme={theme} forceColorScheme="dark">
      <WordsProvider value={words}>
        <LiveProvider>
          <Page />
        </LiveProvider>
      </WordsProvider>
    </MantineProvider>
  </StrictMode>,
);
