// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Double frame buffer of |w|, read in raster order, a taxel a cycle. A seed is a taxel above a limit; each comes with
// the label that a component beginning there would get. A step without a seed ends each row.
//
// Latency from start to the first step: 5 cycles, then a step a cycle; weight is a cycle behind its step.

`default_nettype none

module sptfra_weight_raster #(
    // 4: weights come by orbits of a folded grid; 1: by taxels
    parameter CHANNELS = 4,
    // Taxels in x and y
    parameter COLUMNS = 10,
    parameter ROWS = 10,
    // Bits of |w|, of an orbit's or taxel's number, and of a label
    parameter DATA_BITS = 27,
    parameter ROW_WIDTH = 5,
    parameter LABEL_WIDTH = 4
) (
    input  wire clock,
    input  wire reset,
    // Weights, and which of the two frames they are of
    input  wire weights_valid,
    input  wire weights_bank,
    input  wire [ROW_WIDTH-1:0] weights_row,
    input  wire [CHANNELS*DATA_BITS-1:0] weights, // image 0 in the lowest bits
    // The frame that passes, held until its last step
    input  wire start,
    input  wire bank,
    input  wire [DATA_BITS-1:0] limit, // from the cycle after start
    // Its steps
    output wire step,
    output reg  seed,
    output wire [LABEL_WIDTH-1:0] fresh,
    output reg  [DATA_BITS-1:0] weight,
    output wire last
);

    localparam X_WIDTH = $clog2(COLUMNS + 1);
    localparam Y_WIDTH = $clog2(ROWS);
    localparam [31:0] BORDER = COLUMNS;
    localparam [31:0] LAST_Y = ROWS - 1;

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
    reg [3:1] borders;
    reg [4:1] steps;
    reg [4:1] lasts;
    reg [4*LABEL_WIDTH-1:0] names; // of stages 1 to 4: the row, odd or even, and half the column

    assign step = steps[4];
    assign last = lasts[4];
    assign fresh = names[3*LABEL_WIDTH +: LABEL_WIDTH];

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
        weight <= weight_4;
        seed <= !borders[3] && (weight_3 > limit);
        borders <= {borders[2:1], border};
        steps <= {steps[3:1], walks};
        lasts <= {lasts[3:1], walks && last_step};
        names <= {names[3*LABEL_WIDTH-1:0], row[0], column_wide[LABEL_WIDTH-1:1]};
        if (reset) begin
            steps <= 4'd0;
            lasts <= 4'd0;
        end
    end

    wire _unused = &{1'b0, column_wide};

endmodule

`default_nettype wire
