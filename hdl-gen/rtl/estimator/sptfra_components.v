// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// One-pass connected-component labelling of |w|: it counts components of seeds whose sum reaches `least`.
//
// A double buffer holds the frames. One passes in raster order, one taxel a cycle. A seed is a taxel above the limit.
// Seeds that are neighbours along x or y are of one component. Its sum is that of |w|. The labels of the last row's
// taxels stand in a shift register, one step longer than a row. Each row ends with a step that is no seed. A taxel
// whose neighbours have two labels renames one to the other in the same cycle, everywhere in the register. A new label
// is the parity of its row and half its column. So each run of seeds has a label of its own in its row. The run gives
// it to the component above. The labels of a row are free again two rows later: any grid needs COLUMNS + 1 at most.
//
// A run of taxels adds its own and, where it joins another component, that one's sum. Between two runs a taxel passes
// that does not count, so that a sum is written before anything can join it. Sums only grow: one that reaches the
// least is one more, two of them that join are one less. From start to the count: (COLUMNS + 1) * ROWS + 8 cycles.

`default_nettype none

module sptfra_components #(
    // 4: weights come by orbits of a folded grid; 1: by taxels
    parameter CHANNELS = 4,
    // Taxels in x and y
    parameter COLUMNS = 10,
    parameter ROWS = 10,
    // Bits of |w|, of a sum, which has more, and of an orbit's or taxel's number
    parameter DATA_BITS = 27,
    parameter SUM_BITS = 34,
    parameter ROW_WIDTH = 5
) (
    input  wire clock,
    input  wire reset,
    // Weights, and which of the two frames they are of
    input  wire weights_valid,
    input  wire weights_bank,
    input  wire [ROW_WIDTH-1:0] weights_row,
    input  wire [CHANNELS*DATA_BITS-1:0] weights, // image 0 in the lowest bits
    // The frame that passes, held until it is done
    input  wire start,
    input  wire bank,
    input  wire [DATA_BITS-1:0] limit, // this and least from the cycle after start
    input  wire [SUM_BITS-1:0] least,
    output wire done, // one cycle
    // Components whose sum reaches least: at most 12 have 5/64 of all
    output reg  [3:0] contacts
);

    localparam X_WIDTH = $clog2(COLUMNS + 1);
    localparam Y_WIDTH = $clog2(ROWS);
    localparam LABEL_WIDTH = (COLUMNS > 4) ? $clog2((COLUMNS + 1) / 2) + 1 : 2; // the row, odd or even, half the column
    localparam [31:0] BORDER = COLUMNS;
    localparam [31:0] LAST_Y = ROWS - 1;
    localparam [SUM_BITS-1:0] NOTHING = 0;

    // ---- Where the step is: a border behind each row
    reg walks;
    reg [X_WIDTH-1:0] column;
    reg [Y_WIDTH-1:0] row;
    wire border = (column == BORDER[X_WIDTH-1:0]);
    wire last_step = border && (row == LAST_Y[Y_WIDTH-1:0]);
    wire [31:0] column_wide = {{(32-X_WIDTH){1'b0}}, column};

    always @(posedge clock) begin
        if (start) begin
            walks <= 1'b1;
            column <= {X_WIDTH{1'b0}};
            row <= {Y_WIDTH{1'b0}};
        end else if (walks) begin
            column <= border ? {X_WIDTH{1'b0}} : column + 1'b1;
            if (border) begin
                row <= row + 1'b1;
            end
            walks <= !last_step;
        end
        if (reset) begin
            walks <= 1'b0;
        end
    end

    // ---- Stages 1 and 2: the weights of its orbit. Stage 3: its own. Stage 4: whether it is a seed
    wire [ROW_WIDTH-1:0] element;
    wire [1:0] image;
    reg [ROW_WIDTH:0] address_1;
    wire [CHANNELS*DATA_BITS-1:0] weights_2;
    wire [DATA_BITS-1:0] weight_2;
    reg [1:0] image_1;
    reg [1:0] image_2;
    reg [DATA_BITS-1:0] weight_3;
    reg [DATA_BITS-1:0] weight_4;
    reg [DATA_BITS-1:0] weight_5;
    reg [3:1] borders;
    reg seed_4;
    reg [4:1] steps;
    reg [8:1] lasts;
    reg [4*LABEL_WIDTH-1:0] names; // of stages 1 to 4: a label for a component that would begin there

    assign done = lasts[8];

    if (CHANNELS == 4) begin : gen_orbits
        sptfra_taxel_walk #(
            .COLUMNS (COLUMNS),
            .ROWS    (ROWS)
        ) walk (
            .clock  (clock),
            .rewind (start),
            .step   (walks && !border),
            .taxels (2'd1),
            .orbit  (element),
            .image  (image)
        );

        assign weight_2 = weights_2[DATA_BITS*image_2 +: DATA_BITS];
    end else begin : gen_taxels
        reg [ROW_WIDTH-1:0] taxel;

        assign element = taxel;
        assign image = 2'd0;
        assign weight_2 = weights_2[DATA_BITS-1:0];

        always @(posedge clock) begin
            if (walks && !border) begin
                taxel <= taxel + 1'b1;
            end
            if (start) begin
                taxel <= {ROW_WIDTH{1'b0}};
            end
        end

        wire _unused_image = &{1'b0, image_2};
    end

    sptfra_ram #(
        .WIDTH         (CHANNELS * DATA_BITS),
        .DEPTH         (2 << ROW_WIDTH),
        .ADDRESS_WIDTH (ROW_WIDTH + 1)
    ) frames (
        .clock         (clock),
        .write_enable  (weights_valid),
        .write_address ({weights_bank, weights_row}),
        .write_data    (weights),
        .read_enable   (1'b1),
        .read_address  (address_1),
        .read_data     (weights_2)
    );

    always @(posedge clock) begin
        address_1 <= {bank, element};
        image_1 <= image;
        image_2 <= image_1;
        weight_3 <= weight_2;
        weight_4 <= weight_3;
        weight_5 <= weight_4;
        seed_4 <= !borders[3] && (weight_3 > limit);
        borders <= {borders[2:1], border};
        steps <= {steps[3:1], walks};
        lasts <= {lasts[7:1], walks && last_step};
        names <= {names[3*LABEL_WIDTH-1:0], row[0], column_wide[LABEL_WIDTH-1:1]};
        if (reset) begin
            steps <= 4'd0;
            lasts <= 8'd0;
        end
    end

    // ---- Stage 5: the taxel's label. Seeds of the last row's steps, the newest in the lowest bits
    reg [COLUMNS:0] there;
    reg [LABEL_WIDTH*(COLUMNS+1)-1:0] labels;
    wire [LABEL_WIDTH-1:0] above = labels[LABEL_WIDTH*COLUMNS +: LABEL_WIDTH];
    wire [LABEL_WIDTH-1:0] own = there[0] ? labels[LABEL_WIDTH-1:0] : names[3*LABEL_WIDTH +: LABEL_WIDTH];
    wire meets = seed_4 && there[COLUMNS] && (above != own);
    wire [LABEL_WIDTH*(COLUMNS+1)-1:0] renamed;
    // What the taxel is
    reg counts_5; // a seed,
    reg begins_5; // the first of a run,
    reg [LABEL_WIDTH-1:0] label_5;
    reg joins_5; // and it joins another component above,
    reg [LABEL_WIDTH-1:0] joined_5; // which had this label until now
    genvar index;

    for (index = 0; index <= COLUMNS; index = index + 1) begin : gen_labels
        wire [LABEL_WIDTH-1:0] old = labels[LABEL_WIDTH*index +: LABEL_WIDTH];

        assign renamed[LABEL_WIDTH*index +: LABEL_WIDTH] = (meets && (old == above)) ? own : old;
    end

    always @(posedge clock) begin
        if (steps[4]) begin
            there <= {there[COLUMNS-1:0], seed_4};
            labels <= {renamed[LABEL_WIDTH*COLUMNS-1:0], own};
        end
        if (start) begin
            there <= {(COLUMNS+1){1'b0}};
        end
        counts_5 <= steps[4] && seed_4;
        begins_5 <= !there[0];
        label_5 <= own;
        joins_5 <= meets;
        joined_5 <= above;
    end

    // ---- Stage 6: the sum that is joined
    (* ram_style = "distributed" *) reg [SUM_BITS-1:0] sums [0:(1<<LABEL_WIDTH)-1];
    reg [SUM_BITS-1:0] joined_6;
    reg [DATA_BITS-1:0] weight_6;
    reg [LABEL_WIDTH-1:0] label_6;
    reg counts_6;
    reg begins_6;

    always @(posedge clock) begin
        joined_6 <= joins_5 ? sums[joined_5] : NOTHING;
        weight_6 <= weight_5;
        label_6 <= label_5;
        counts_6 <= counts_5;
        begins_6 <= begins_5;
    end

    // ---- Stage 7: the sum of the run and of all that it has joined
    reg [SUM_BITS-1:0] sum;
    reg counts_7;
    reg begins_7;
    reg joined_contact_7;
    wire [SUM_BITS-1:0] grown = (begins_6 ? NOTHING : sum) + {{(SUM_BITS-DATA_BITS){1'b0}}, weight_6} + joined_6;

    always @(posedge clock) begin
        if (counts_6) begin
            sum <= grown;
            sums[label_6] <= grown;
        end
        counts_7 <= counts_6;
        begins_7 <= begins_6;
        joined_contact_7 <= (joined_6 >= least);
    end

    // ---- Stage 8: whether it is a contact, and was one
    reg was_contact;
    wire is_contact = (sum >= least);
    wire was_counted = was_contact && !begins_7;

    always @(posedge clock) begin
        if (counts_7) begin
            was_contact <= is_contact;
            contacts <= contacts + {3'd0, is_contact} - {3'd0, was_counted} - {3'd0, joined_contact_7};
        end
        if (start) begin
            contacts <= 4'd0;
        end
    end

    wire _unused = &{1'b0, column_wide, renamed[LABEL_WIDTH*COLUMNS +: LABEL_WIDTH]};

endmodule

`default_nettype wire
