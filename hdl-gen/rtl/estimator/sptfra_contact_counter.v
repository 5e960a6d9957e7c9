// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Contact counter: one-pass connected-component labelling of |w|, with the components' sums.
//
// A taxel above 5/64 of the frame's largest |w| is a seed. Seeds that are neighbours along x or y are one connected
// component. A component with 5/64 of all |w| is a contact. If none has, and without any |w|, the count is 1.
//
// Takes the weights as We makes them, in any order, an orbit or a taxel a cycle. Buffers two frames. Then the taxels
// pass in raster order, one a cycle, with a step between rows. Latency from the last weights to the count:
// (COLUMNS + 1) * ROWS + 12 cycles. Any search takes longer, so nothing ever waits here; simulations check it.

`default_nettype none

module sptfra_contact_counter #(
    // 4: weights come by orbits of a folded grid; 1: by taxels
    parameter CHANNELS = 4,
    // Taxels in x and y
    parameter COLUMNS = 10,
    parameter ROWS = 10,
    // Bits of |w|
    parameter DATA_BITS = 27,
    // From the last weights of a frame to its count, if none is counted just then, checked in simulation; 0: unchecked
    parameter integer EXPECTED_LATENCY = 0,
    // Derived
    parameter ELEMENTS = (CHANNELS == 4) ? ((COLUMNS + 1) / 2) * ((ROWS + 1) / 2) : COLUMNS * ROWS,
    parameter ROW_WIDTH = (ELEMENTS > 8) ? $clog2(ELEMENTS) : 3
) (
    input  wire clock,
    input  wire reset,
    // Weights, from We
    input  wire weights_valid,
    input  wire [ROW_WIDTH-1:0] weights_row,
    input  wire [CHANNELS*DATA_BITS-1:0] weights, // image 0 in the lowest bits
    // To Op: contacts of the oldest frame of which no output has begun
    output wire [7:0] contacts,
    input  wire contacts_take
);

    if ((CHANNELS != 1) && (CHANNELS != 4)) begin : gen_check_channels
        sptfra_error_channels_must_be_1_or_4 invalid ();
    end
    if ((COLUMNS < 2) || (ROWS < 2) || (COLUMNS > 64) || (ROWS > 64)) begin : gen_check_grid
        sptfra_error_columns_and_rows_must_be_2_to_64 invalid ();
    end

    localparam SUM_BITS = DATA_BITS + $clog2(COLUMNS * ROWS) + 1;
    localparam [31:0] LAST_ELEMENT = ELEMENTS - 1;

    // ---- Weights as they come: which frame they are of
    reg fill_bank;
    reg [ROW_WIDTH-1:0] filled;
    wire first_weights = (filled == {ROW_WIDTH{1'b0}});
    wire last_weights = weights_valid && (filled == LAST_ELEMENT[ROW_WIDTH-1:0]);

    always @(posedge clock) begin
        if (weights_valid) begin
            filled <= last_weights ? {ROW_WIDTH{1'b0}} : filled + 1'b1;
        end
        if (last_weights) begin
            fill_bank <= !fill_bank;
        end
        if (reset) begin
            filled <= {ROW_WIDTH{1'b0}};
            fill_bank <= 1'b0;
        end
    end

    // ---- Their sum and the largest, held until the next frame's first. Index k: k cycles after the weights
    localparam IMAGES_BITS = DATA_BITS + 2; // of the sum of all images
    reg [3:1] valids;
    reg [3:1] firsts; // of a frame
    reg [4:1] ends; // of its weights
    reg [SUM_BITS-1:0] total;
    reg [DATA_BITS-1:0] largest;
    wire [IMAGES_BITS-1:0] sum_3; // of the images
    wire [DATA_BITS-1:0] largest_3;
    wire totals_there = ends[4]; // one cycle

    always @(posedge clock) begin
        valids <= {valids[2:1], weights_valid};
        firsts <= {firsts[2:1], first_weights};
        ends <= {ends[3:1], last_weights};
        if (valids[3]) begin
            total <= (firsts[3] ? {SUM_BITS{1'b0}} : total) + {{(SUM_BITS-IMAGES_BITS){1'b0}}, sum_3};
            largest <= (firsts[3] || (largest_3 > largest)) ? largest_3 : largest;
        end
        if (reset) begin
            valids <= 3'd0;
            ends <= 4'd0;
        end
    end

    if (CHANNELS == 4) begin : gen_orbits
        // On a centre line of the grid images of an orbit are the same taxel, which counts once
        wire [3:0] are_own;
        reg [3:0] are_own_1;
        reg [4*DATA_BITS-1:0] weights_1;
        wire [4*IMAGES_BITS-1:0] own_1;
        wire [2*IMAGES_BITS-1:0] sum_halves; // not needed
        wire [2*DATA_BITS-1:0] largest_halves;
        genvar index;

        sptfra_orbit_images #(
            .COLUMNS   (COLUMNS),
            .ROWS      (ROWS),
            .ROW_WIDTH (ROW_WIDTH)
        ) images (
            .orbit  (weights_row),
            .counts (are_own)
        );

        always @(posedge clock) begin
            are_own_1 <= are_own;
            weights_1 <= weights;
        end

        for (index = 0; index < 4; index = index + 1) begin : gen_images
            assign own_1[IMAGES_BITS*index +: IMAGES_BITS]
                = are_own_1[index] ? {2'b00, weights_1[DATA_BITS*index +: DATA_BITS]} : {IMAGES_BITS{1'b0}};
        end

        sptfra_tree #(
            .COUNT (4),
            .WIDTH (IMAGES_BITS)
        ) sum_of_images (
            .clock   (clock),
            .numbers (own_1),
            .halves  (sum_halves),
            .result  (sum_3)
        );

        sptfra_tree #(
            .COUNT   (4),
            .WIDTH   (DATA_BITS),
            .LARGEST (1)
        ) largest_of_images (
            .clock   (clock),
            .numbers (weights_1),
            .halves  (largest_halves),
            .result  (largest_3)
        );

        wire _unused = &{1'b0, sum_halves, largest_halves};
    end else begin : gen_taxels
        reg [3*DATA_BITS-1:0] passing; // in as many stages

        assign sum_3 = {2'b00, largest_3};
        assign largest_3 = passing[2*DATA_BITS +: DATA_BITS];

        always @(posedge clock) begin
            passing <= {passing[2*DATA_BITS-1:0], weights};
        end
    end

    // ---- A frame's turn: 5/64 of the largest and of all, then its taxels
    reg waits; // a frame is there, and another one is counted
    reg busy;
    reg read_bank;
    reg [DATA_BITS-1:0] limit;
    reg [SUM_BITS-1:0] least;
    wire done;
    wire start = (totals_there || waits) && !busy;
    wire [DATA_BITS+2:0] largest_5 = {1'b0, largest, 2'b00} + {3'b000, largest};
    wire [SUM_BITS+2:0] total_5 = {1'b0, total, 2'b00} + {3'b000, total} + {{(SUM_BITS-3){1'b0}}, 6'd63};

    always @(posedge clock) begin
        waits <= (totals_there || waits) && busy;
        if (start) begin
            busy <= 1'b1;
            limit <= {3'b000, largest_5[DATA_BITS+2:6]};
            least <= {3'b000, total_5[SUM_BITS+2:6]};
        end
        if (done) begin
            busy <= 1'b0;
            read_bank <= !read_bank;
        end
        if (reset) begin
            waits <= 1'b0;
            busy <= 1'b0;
            read_bank <= 1'b0;
        end
    end

    wire [3:0] found;

    sptfra_components #(
        .CHANNELS  (CHANNELS),
        .COLUMNS   (COLUMNS),
        .ROWS      (ROWS),
        .DATA_BITS (DATA_BITS),
        .SUM_BITS  (SUM_BITS),
        .ROW_WIDTH (ROW_WIDTH)
    ) components (
        .clock         (clock),
        .reset         (reset),
        .weights_valid (weights_valid),
        .weights_bank  (fill_bank),
        .weights_row   (weights_row),
        .weights       (weights),
        .start         (start),
        .bank          (read_bank),
        .limit         (limit),
        .least         (least),
        .done          (done),
        .contacts      (found)
    );

    // ---- Counts until their frames go out: of two frames that are searched, of one at each later stage; five at most
    reg [31:0] counts;
    reg [3:0] waiting; // counts there
    wire [3:0] next_count = (found == 4'd0) ? 4'd1 : found;
    wire [3:0] left = waiting - {3'd0, contacts_take};
    wire [31:0] counts_left = contacts_take ? counts >> 4 : counts;

    assign contacts = {4'd0, counts[3:0]};

    always @(posedge clock) begin
        waiting <= left + {3'd0, done};
        counts <= counts_left;
        if (done) begin
            counts[{left[2:0], 2'd0} +: 4] <= next_count;
        end
        if (reset) begin
            waiting <= 4'd0;
        end
    end

`ifdef SIMULATION
    reg [1:0] frames_inside; // whose weights are there and that are not counted

    always @(posedge clock) begin
        frames_inside <= frames_inside + {1'b0, last_weights} - {1'b0, done};
        if (!reset && done && (left == 4'd8)) begin
            $fdisplay(32'h80000002, "%m: a ninth count has no place");
            $fatal(1);
        end
        if (!reset && contacts_take && (waiting == 4'd0)) begin
            $fdisplay(32'h80000002, "%m: a frame goes out before its contacts are counted");
            $fatal(1);
        end
        if (!reset && weights_valid && (frames_inside == 2'd2)) begin
            $fdisplay(32'h80000002, "%m: weights of a third frame come before the first one is counted");
            $fatal(1);
        end
        if (reset) begin
            frames_inside <= 2'd0;
        end
    end

    sptfra_check_latency #(
        .CYCLES (EXPECTED_LATENCY)
    ) check_latency (
        .clock (clock),
        .reset (reset),
        .start (last_weights && (frames_inside == 2'd0)),
        .done  (done)
    );
`else
    wire _unused_check = (EXPECTED_LATENCY != 0);
`endif

    wire _unused = &{1'b0, largest_5[5:0], total_5[5:0]};

endmodule

`default_nettype wire
