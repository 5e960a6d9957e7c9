// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Tare: mean stress of each taxel over 2^log2_frames frames, and whether they are steady. Steady frames are whole,
// hold numbers that are not clipped, and spread by at most most_spread on each taxel.
//
// A taxel's sum and extremes are read two cycles before its next stress and written with it. So a frame has four
// taxels at least. A mean is there three cycles after mean_taxel.

`default_nettype none

module sptfra_tare #(
    // Taxels of a frame
    parameter TAXELS = 100,
    // Derived
    parameter TAXEL_WIDTH = (TAXELS > 2) ? $clog2(TAXELS) : 1
) (
    input  wire clock,
    input  wire reset,
    // Command: low forgets all
    input  wire run,
    input  wire [3:0] log2_frames, // 10 at most
    input  wire [26:0] most_spread,
    // Readings
    input  wire valid,
    input  wire marked, // of a frame that began after the command
    input  wire last,
    input  wire bad,
    input  wire [TAXEL_WIDTH-1:0] taxel_ahead, // of two cycles before the reading
    input  wire signed [26:0] reading,
    // Result
    output wire finished,
    output reg  restless, // spread too far
    output reg  bad_frame,
    input  wire [TAXEL_WIDTH-1:0] mean_taxel, // once finished
    output wire signed [26:0] mean
);

    localparam SUM_BITS = 37; // of 2^10 readings
    localparam WIDTH = SUM_BITS + 2 * 27;

    reg [10:0] frames; // whole ones
    reg first_frame;
    reg [2:0] complete; // no reading counts any more, and two cycles later its spread is known
    wire [10:0] most_frames = 11'd1 << log2_frames;
    wire takes = run && !complete[0] && valid && marked;

    assign finished = complete[2];

    // ---- What the frames before had
    wire [WIDTH-1:0] stored_9;
    reg [TAXEL_WIDTH-1:0] taxel_9;
    reg [TAXEL_WIDTH-1:0] taxel;
    reg signed [SUM_BITS-1:0] sum_10;
    reg signed [26:0] largest_10;
    reg signed [26:0] smallest_10;
    wire signed [SUM_BITS-1:0] reading_wide = {{(SUM_BITS-27){reading[26]}}, reading};
    wire signed [SUM_BITS-1:0] sum = first_frame ? reading_wide : sum_10 + reading_wide;
    wire signed [26:0] largest = (first_frame || (reading > largest_10)) ? reading : largest_10;
    wire signed [26:0] smallest = (first_frame || (reading < smallest_10)) ? reading : smallest_10;

    sptfra_ram #(
        .WIDTH         (WIDTH),
        .DEPTH         (1 << TAXEL_WIDTH),
        .ADDRESS_WIDTH (TAXEL_WIDTH)
    ) readings (
        .clock         (clock),
        .write_enable  (takes),
        .write_address (taxel),
        .write_data    ({sum, largest, smallest}),
        .read_enable   (1'b1),
        .read_address  (complete[0] ? mean_taxel : taxel_ahead),
        .read_data     (stored_9)
    );

    always @(posedge clock) begin
        taxel_9 <= taxel_ahead;
        taxel <= taxel_9;
        {sum_10, largest_10, smallest_10} <= stored_9;
    end

    // ---- Spread, and the end
    reg signed [26:0] largest_11;
    reg signed [26:0] smallest_11;
    reg check_11;
    wire signed [27:0] spread_11 = {largest_11[26], largest_11} - {smallest_11[26], smallest_11};

    always @(posedge clock) begin
        largest_11 <= largest;
        smallest_11 <= smallest;
        check_11 <= takes;
        if (check_11 && (spread_11 > $signed({1'b0, most_spread}))) begin
            restless <= 1'b1;
        end
        if (takes && bad) begin
            bad_frame <= 1'b1;
        end
        complete <= {complete[1:0], complete[0]};
        if (takes && last) begin
            first_frame <= 1'b0;
            frames <= frames + 11'd1;
        end
        if (takes && (bad || (last && (frames + 11'd1 == most_frames)))) begin
            complete[0] <= 1'b1;
        end
        if (restless) begin
            complete[0] <= 1'b1;
        end
        if (reset || !run) begin
            frames <= 11'd0;
            first_frame <= 1'b1;
            complete <= 3'd0;
            check_11 <= 1'b0;
            restless <= 1'b0;
            bad_frame <= 1'b0;
        end
    end

    // ---- The mean, rounded
    wire signed [SUM_BITS-1:0] half = (37'sd1 <<< log2_frames) >>> 1;
    wire signed [SUM_BITS-1:0] rounded = (sum_10 + half) >>> log2_frames;

    assign mean = rounded[26:0];

    wire _unused = &{1'b0, rounded[SUM_BITS-1:27]};

endmodule

`default_nettype wire
