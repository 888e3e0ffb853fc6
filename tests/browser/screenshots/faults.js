// Layout faults of the displayed page that a machine can find, as sentences.
() => {
    const faults = new Set();
    const name = (element) => {
        const { testid } = element.dataset ?? {};
        const kind = element.tagName.toLowerCase();
        const named = testid ? `[${testid}]` : [...element.classList].slice(0, 2).map((one) => `.${one}`).join("");
        const text = (element.innerText ?? element.textContent ?? "").trim().replace(/\s+/g, " ").slice(0, 40);
        // Figures change from image to image.
        return `${kind}${named} "${text.replace(/[−-]?\d+(\.\d+)?/g, "#")}"`;
    };
    const isShown = (element) =>
        element.checkVisibility({ opacityProperty: true, visibilityProperty: true }) &&
        element.closest("[inert], dialog:not([open])") === null;
    const area = ({ width, height }) => Math.max(width, 0) * Math.max(height, 0);
    // Part of a box that its clipping ancestors let through, and the first that cuts text off.
    const clipped = (element, box) => {
        let [left, top, right, bottom] = [box.left, box.top, box.right, box.bottom];
        let cutBy = null;
        const [canScroll, slack] = [{ x: false, y: false }, parseFloat(getComputedStyle(element).fontSize) * 0.3];
        for (let at = element; at !== null; at = at.parentElement) {
            const { overflowX, overflowY, overflowClipMargin, position } = getComputedStyle(at);
            const isRoot = at === document.documentElement;
            const edge = isRoot
                ? { left: 0, top: 0, right: innerWidth, bottom: innerHeight }
                : at.getBoundingClientRect();
            const [hidesX, hidesY] = [/hidden|clip/.test(overflowX), /hidden|clip/.test(overflowY)];
            const margin = overflowX === "clip" ? parseFloat(overflowClipMargin) || 0 : 0;
            const outX = !canScroll.x && (edge.left - box.left > margin + 1 || box.right - edge.right > margin + 1);
            const outY = !canScroll.y && (edge.top - box.top > slack || box.bottom - edge.bottom > slack);
            if ((hidesX && outX) || (hidesY && outY)) cutBy ??= at;
            if (overflowX !== "visible") [left, right] = [Math.max(left, edge.left), Math.min(right, edge.right)];
            if (overflowY !== "visible") [top, bottom] = [Math.max(top, edge.top), Math.min(bottom, edge.bottom)];
            canScroll.x ||= /auto|scroll/.test(overflowX);
            canScroll.y ||= /auto|scroll/.test(overflowY);
            if (position === "fixed") break;
        }
        return { seen: new DOMRect(left, top, right - left, bottom - top), cutBy };
    };

    // What floats above the page, with a ground of its own.
    const layerOf = (target) => {
        for (let at = target.parentElement; at !== null; at = at.parentElement) {
            const { position, backgroundColor } = getComputedStyle(at);
            if (at.role === "dialog") return at;
            if (/absolute|fixed|sticky/.test(position) && /^rgb\(/.test(backgroundColor)) return at;
        }
        return null;
    };

    const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (texts.nextNode()) {
        const text = texts.currentNode;
        const element = text.parentElement;
        if (text.data.trim() === "" || element.closest("svg, script, style, option, select, .skip") || !isShown(element)) continue;
        const range = document.createRange();
        range.selectNodeContents(text);
        const box = range.getBoundingClientRect();
        if (area(box) === 0) continue;
        const { cutBy } = clipped(element, box);
        // Text for screen readers has a box of one pixel.
        if (cutBy === null || cutBy.clientWidth <= 2) continue;
        const kind = getComputedStyle(cutBy).textOverflow === "ellipsis" ? "text shortened" : "text cut off";
        faults.add(`${kind}: ${name(element)} by ${name(cutBy).split(" ")[0]}`);
    }

    const targets = [...document.querySelectorAll("button, a[href], input, select, textarea, summary, [role=button], [role=slider]")]
        .filter((one) => one.type !== "file" && isShown(one))
        .map((one) => ({ one, target: /radio|checkbox/.test(one.type) ? (one.labels[0] ?? one) : one }))
        .filter(({ one }) => !(one.tagName === "A" && getComputedStyle(one).display === "inline"))
        .map(({ one, target }) => ({ one, target, box: target.getBoundingClientRect() }))
        .map((found) => ({ ...found, seen: clipped(found.target, found.box).seen }))
        .filter(({ seen }) => seen.width > 1 && seen.height > 1);
    for (const [index, first] of targets.entries()) {
        for (const second of targets.slice(index + 1)) {
            if (first.target.contains(second.target) || second.target.contains(first.target)) continue;
            if (layerOf(first.target) !== layerOf(second.target)) continue;
            const [a, b] = [first.seen, second.seen];
            const width = Math.min(a.right, b.right) - Math.max(a.left, b.left);
            const height = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
            if (width > 1 && height > 1) faults.add(`overlap: ${name(first.one)} and ${name(second.one)}`);
        }
    }

    const { scrollWidth, clientWidth } = document.documentElement;
    if (scrollWidth > clientWidth + 1) faults.add(`scrolls sideways: ${scrollWidth} px on ${clientWidth} px`);
    return [...faults];
}
